"""Where a channel repeats one value exactly: clipped at an end, or held and let go."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from hystbench.record import FloatArray

APPROACH = 3
"""Samples of a flat stretch, and of the motion on either side, that tell anything."""
ALIKE = 1 / 3
"""Least rate of the slower flank, as a share of the faster one's. A backlash stands
still behind its turn, where it came to rest, and not in the middle of it."""
AT_ONCE = 2 / 3
"""A channel stops at once if its rate next to the flat is more than this share of its
rate farther out. It is half where the channel comes to rest smoothly, and five sixths
or more where a parabola is cut off."""
BEYOND = 0.01
"""Share of the range by which the flanks of a flat stretch would have gone beyond
it."""
CHANCE = 0.01
"""Stretches that a whole record would have by chance, below which one is none: readings
of few digits are alike now and then."""
READINGS = 20
"""Changes of a channel that all lie at every k-th sample, where chance is no cause."""
COARSE = 3.0
"""Steps of a digitized channel: what is nearer is its own rounding."""


@dataclass(frozen=True)
class Flat:
    """Stretches in which a channel repeats one value while it should move."""

    kind: Literal["clipped", "stuck"]
    value: float
    """Value of the first stretch."""
    first: int
    """Its first sample, counted from 0."""
    samples: int
    stretches: int
    """Count of all stretches of this kind and, where clipped, of this end."""


@dataclass(frozen=True)
class FlatPart:
    """Samples in which a channel repeats one value while it should move."""

    kind: Literal["clipped", "stuck"]
    first: int
    behind: int
    """Its first sample and the one behind its last, counted from 0."""


def flats(values: FloatArray) -> list[Flat]:
    """Find where a channel is clipped or stuck, by its own values alone.

    Parameters
    ----------
    values : ndarray, shape (n,)

    Returns
    -------
    list of Flat
        At most one for each end and one that is stuck.
    """
    found: dict[tuple[str, float], list[FlatPart]] = {}
    for part in stretches(values):
        end = float(values[part.first]) if part.kind == "clipped" else 0.0
        found.setdefault((part.kind, end), []).append(part)
    return [
        Flat(
            parts[0].kind,
            float(values[parts[0].first]),
            parts[0].first,
            sum(part.behind - part.first for part in parts),
            len(parts),
        )
        for parts in found.values()
    ]


def stretches(values: FloatArray) -> list[FlatPart]:
    """Find each stretch in which a channel is clipped or stuck, by its values alone.

    *Clipped*: it stands at its largest or smallest value, exactly, and came and went
    so fast that a parabola through both flanks would have reached beyond by more than
    a hundredth of the range: half the flat's length times a half of the slower
    flank's rate. A smooth turn that is digitized stays within a step.

    *Stuck*: it stands elsewhere, for longer than two alike readings here and there
    predict, and jumps at the end at least half as far as the motion before would have
    gone meanwhile.

    Parameters
    ----------
    values : ndarray, shape (n,)

    Returns
    -------
    list of FlatPart
        In the order of the record.
    """
    moves = np.diff(values)
    span = float(np.ptp(values))
    if not span > 0:
        return []
    quantum = smallest_step(values)
    matters = max(BEYOND * span, COARSE * quantum)
    ends = (float(values.min()), float(values.max()))
    lengths = [behind - first for first, behind in repeats(values, 2)]
    pairs = lengths.count(2)
    found: list[FlatPart] = []
    for first, behind in repeats(values, APPROACH):
        length = behind - first
        if first < APPROACH or behind + APPROACH > len(values):
            continue
        value = float(values[first])
        before, stopped = _flank(values[first::-1], length, quantum)
        after, left = _flank(values[behind - 1 :], length, quantum)
        if value in ends:
            outward = 1.0 if value == ends[1] else -1.0
            slower, faster = sorted((-outward * before, -outward * after))
            steep = slower * length / 4 > matters and slower > ALIKE * faster
            if steep and stopped and left:
                found.append(FlatPart("clipped", first, behind))
            continue
        if pairs * (pairs / len(values)) ** (length - 2) > CHANCE:
            continue
        moved = bool((moves[first - APPROACH : first] != 0).all())
        jump = (values[behind] - value) * -np.sign(before)
        if moved and jump > max(abs(before) * length / 2, matters):
            found.append(FlatPart("stuck", first, behind))
    return found


def is_cut_off(values: FloatArray, first: int, behind: int) -> bool:
    """Tell whether a channel stops at a rate, and moves off at one, around a flat.

    At an end of the record there is only the other flank.

    Parameters
    ----------
    values : ndarray, shape (n,)
    first, behind : int
        The flat's first sample and the one behind its last.
    """
    before, after = first, len(values) - behind
    if any(0 < flank < APPROACH for flank in (before, after)) or not before + after:
        return False
    quantum, length = smallest_step(values), behind - first
    flanks = values[first::-1], values[behind - 1 :]
    return all(_flank(x, length, quantum)[1] for x in flanks if len(x) > 1)


def _flank(flank: FloatArray, length: int, quantum: float) -> tuple[float, bool]:
    """Tell at what rate a channel leaves a flat, and whether at once: not from rest.

    Over a quarter of the flat, in which steps of a digitized channel average out. Where
    they are so coarse that one more would make the difference, it does not.
    """
    near = min(max(APPROACH, length // 4), len(flank) - 1)
    over = float(flank[near] - flank[0]) / near
    moving = flank[1 : 1 + max(APPROACH, length // 2)]  # it stopped between samples
    half = len(moving) // 2
    whole, within = (abs(moving[k] - moving[0]) / k for k in (len(moving) - 1, half))
    return over, bool(within - quantum / half > AT_ONCE * whole)


def held_for(values: FloatArray) -> int:
    """Give the samples for which a channel holds each of its values; else one.

    A sensor that is read more slowly than it is logged changes at every k-th sample
    only, counted from any of its changes.

    Parameters
    ----------
    values : ndarray, shape (n,)
    """
    changes = np.flatnonzero(np.diff(values))
    if len(changes) < READINGS:
        return 1
    return int(np.gcd.reduce(np.diff(changes)))


def smallest_step(values: FloatArray) -> float:
    """Give the smallest step of a channel, or zero where it is constant.

    It is at least what the channel is digitized by.
    """
    moves = np.abs(np.diff(values))
    return float(moves[moves > 0].min()) if moves.any() else 0.0


def repeats(values: FloatArray, least: float) -> list[tuple[int, int]]:
    """Give the stretches of one value that are at least so many samples long.

    Returns
    -------
    list of (int, int)
        Of each the first sample and the one behind the last.
    """
    edges = np.concatenate([[0], np.flatnonzero(np.diff(values)) + 1, [len(values)]])
    long = np.flatnonzero(np.diff(edges) >= least)
    return list(zip(edges[long].tolist(), edges[long + 1].tolist(), strict=True))
