"""Lone samples, far off the others: dropouts, spikes, a recorder's error code."""

import numpy as np

from hystbench.flat import COARSE, smallest_step
from hystbench.gap.records.lone_samples import FAR_DEVIATIONS, usual_deviation
from hystbench.inspection.input_summary import runs
from hystbench.record import FloatArray, Mask, Record

MOST = 5
"""Lone samples that may be close together: more are a motion, or a channel that is
stuck."""
NEAR = 6
"""Samples on either side that they are held against: more of them than may be lone."""
FEW = 0.01
"""Share of a record: what comes more often belongs to the signal."""


def lone_samples(record: Record) -> dict[str, list[tuple[int, int]]]:
    """Find the lone samples of a record.

    A sample is *bent* where it differs from the mean of the two beside it by more than
    normal noise ever does. Of a few bent samples close together those are lone that lie
    outside the range of the neighbours behind and before them by more than that range:
    so no turn, corner or jump is. What comes as the other channel is bent is its
    answer, or cause.

    Parameters
    ----------
    record : Record

    Returns
    -------
    dict of str to list of (int, int)
        Of ``input`` and ``output`` the first sample of each stretch, from 0, and the
        one behind its last.
    """
    return {
        "input": _lone(record.u, _bent(record.y)),
        "output": _lone(record.y, _bent(record.u)),
    }


def _bent(values: FloatArray) -> Mask:
    """Mark what differs from the mean of the two samples beside it.

    Of a channel that is coarsely digitized most bends are zero, and so is their
    deviation: its rounding is what is as small as that and comes often. A staircase
    bends rarely, twice at a step.
    """
    bend = np.zeros(len(values))
    bend[1:-1] = values[1:-1] - (values[2:] + values[:-2]) / 2
    bent = np.abs(bend) > FAR_DEVIATIONS * usual_deviation(bend)
    rounded = bent & (np.abs(bend) <= COARSE * smallest_step(values))
    return np.asarray(bent & ~rounded if rounded.mean() > 2 * FEW else bent)


def _lone(values: FloatArray, other: Mask) -> list[tuple[int, int]]:
    """Give the lone stretches of a channel, by where the other one is bent."""
    lone = np.zeros(len(values), dtype=np.bool_)
    rounding = COARSE * smallest_step(values)
    places = np.flatnonzero(_bent(values))
    for group in np.split(places, np.flatnonzero(np.diff(places) > MOST) + 1):
        if not len(group):
            continue
        first, behind = int(group[0]), int(group[-1]) + 1
        before, after = values[max(first - NEAR, 0) : first], values[behind:][:NEAR]
        at_an_end = min(len(before), len(after)) < NEAR
        # The sound sample on either side is bent too.
        too_many = len(group) > MOST + 2
        if at_an_end or too_many or other[first:behind].any():
            continue
        near = np.concatenate([before, after])
        span = max(float(np.ptp(near)), rounding)
        own = values[first:behind]
        out = (own < near.min() - span) | (own > near.max() + span)
        # A single one between two of them is within the range by chance.
        out[1:-1] |= out[:-2] & out[2:]
        if np.count_nonzero(out) <= MOST:
            lone[first:behind] = out
    return runs(lone) if lone.mean() <= FEW else []
