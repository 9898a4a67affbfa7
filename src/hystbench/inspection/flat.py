"""Where a channel repeats one value exactly: clipped at an end, or held and let go."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from hystbench.record import FloatArray

APPROACH = 3
"""Samples of a flat stretch, and of the motion on either side, that tell anything."""
ALIKE = 1 / 3
"""Of the faster flank's rate, that the slower one has: a backlash stands still behind
its turn, where it came to rest, and not in the middle of it."""
BEYOND = 0.01
"""Of the range, that the flanks of a flat stretch would have reached beyond it."""
COARSE = 3.0
"""Steps of a digitized channel: what is nearer is its own rounding."""


@dataclass(frozen=True)
class Flat:
    """Stretches in which a channel repeats one value while it should move.

    Parameters
    ----------
    kind : {"clipped", "stuck"}
    value : float
        Of the first stretch.
    first : int
        Its first sample, counted from 0.
    samples, stretches : int
        Of all stretches of this kind and, where clipped, of this end.
    """

    kind: Literal["clipped", "stuck"]
    value: float
    first: int
    samples: int
    stretches: int


def flats(values: FloatArray) -> list[Flat]:
    """Find where a channel is clipped or stuck, by its own values alone.

    *Clipped*: it stands at its largest or smallest value, exactly, and came and went
    so fast that a parabola through both flanks would have reached beyond by more than
    a hundredth of the range: half the flat's length times a half of the slower
    flank's rate. A smooth turn that is digitized stays within a step.

    *Stuck*: it stands elsewhere, and jumps at the end at least half as far as the
    motion before would have gone meanwhile.

    Parameters
    ----------
    values : ndarray, shape (n,)

    Returns
    -------
    list of Flat
        At most one for each end and one that is stuck.
    """
    moves = np.diff(values)
    span = float(np.ptp(values))
    if not span > 0:
        return []
    edges = np.concatenate([[0], np.flatnonzero(moves != 0) + 1, [len(values)]])
    quantum = float(np.abs(moves[moves != 0]).min())
    matters = max(BEYOND * span, COARSE * quantum)
    found: dict[tuple[str, float], list[tuple[int, int]]] = {}
    ends = (float(values.min()), float(values.max()))
    for first, behind in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        length = behind - first
        if length < APPROACH or first < APPROACH or behind + APPROACH > len(values):
            continue
        value = float(values[first])
        # Rates over a quarter of the flat: steps of a digitized channel average out.
        near = max(APPROACH, length // 4)
        back, on = max(first - near, 0), min(behind + near, len(values)) - 1
        before = (value - values[back]) / (first - back)
        after = (values[on] - value) / (on - behind + 1)
        if value in ends:
            outward = 1.0 if value == ends[1] else -1.0
            slower, faster = sorted((outward * before, -outward * after))
            if slower * length / 4 > matters and slower > ALIKE * faster:
                found.setdefault(("clipped", value), []).append((first, behind))
            continue
        moved = bool((moves[first - APPROACH : first] != 0).all())
        jump = (values[behind] - value) * np.sign(before)
        if moved and jump > max(abs(before) * length / 2, matters):
            found.setdefault(("stuck", 0.0), []).append((first, behind))
    return [
        Flat(
            "clipped" if kind == "clipped" else "stuck",
            float(values[parts[0][0]]),
            parts[0][0],
            sum(behind - first for first, behind in parts),
            len(parts),
        )
        for (kind, _), parts in found.items()
    ]
