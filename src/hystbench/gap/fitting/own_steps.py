"""Steps of time of a function that is the base, where they matter beside the gap."""

from collections.abc import Sequence

import numpy as np

from hystbench.blocks.curve import finer
from hystbench.blocks.external import External
from hystbench.blocks.held import Hold
from hystbench.errors import InputError
from hystbench.gap.fitting.on_records import run_base
from hystbench.metrics import rms
from hystbench.model import Model
from hystbench.record import FloatArray, Record
from hystbench.sentences import percent
from hystbench.units import sized

FIRST_ORDER = 2.0
"""What steps of first order miss, in terms of what half of them change."""


def too_long_steps(
    base: Model, records: Sequence[Record], hold: Hold, share: float
) -> list[str]:
    """Say that a base would give another output if its steps were half as long.

    A function of ``u`` and ``dt`` that takes one step a sample makes an error that goes
    with the step. It may look like an effect. So the base is run once more, on the
    fit record that moves fastest, with a sample put between any two. Any other form of
    simulator takes steps of its own. Nothing is said where the change is larger than
    the gap: that is no error that the base makes, its numbers belong to one interval.

    Parameters
    ----------
    base : Model
    records : sequence of Record
        Those to fit.
    hold : {"zero-order", "linear", "band-limited"}
        How the input moves between samples.
    share : float
        Of the power of the gap, that may stay unnamed.

    Returns
    -------
    list of str
        One warning, or none.
    """
    moving = [record for record in records if np.ptp(record.u) > 0]
    if not moving or not any(isinstance(block, External) for block in base.chain):
        return []
    fastest = max(moving, key=lambda record: record.rate)
    halved = Record(
        fastest.name,
        fastest.dt / 2,
        _between(fastest.u, hold),
        np.repeat(fastest.y, 2)[:-1],
        fastest.input,
        fastest.output,
        fastest.origin,
    )
    try:
        (plain,), (again,) = (run_base(base, (x,), hold) for x in (fastest, halved))
    except InputError as error:
        return [f"whether the base's steps are short enough is not known: {error}"]
    scored = fastest.counted
    changed, gap = rms((again[::2] - plain)[scored]), rms((fastest.y - plain)[scored])
    missed = FIRST_ORDER * changed
    if missed**2 <= share * gap**2 or changed > gap:
        return []
    unit = fastest.output.unit
    return [
        f"called with half the sampling interval on {fastest.name}, the base changes "
        f"by {sized(changed, unit)} rms, and steps of first order miss twice as much; "
        f"it leaves {sized(gap, unit)} there. Up to {percent(min(1.0, missed / gap))} "
        "of that may be the error of its own steps, and may look like an effect. Let "
        "the function take shorter steps"
    ]


def _between(u: FloatArray, hold: Hold) -> FloatArray:
    """Put a sample between any two, where the input is there."""
    if hold == "zero-order":
        return np.repeat(u, 2)[:-1]
    if hold == "band-limited" and len(u) > 2:
        return finer(u, 2)
    out = np.empty(2 * len(u) - 1)
    out[::2], out[1::2] = u, (u[:-1] + u[1:]) / 2
    return out
