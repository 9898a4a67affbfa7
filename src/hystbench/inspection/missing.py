"""Where samples are missing: what can be bridged, and where a record is cut."""

import numpy as np

from hystbench.inspection.input_summary import summary_of
from hystbench.record import FloatArray, Mask

BRIDGED_PERIODS = 0.25
"""Of the fastest period of an input, that a straight line may stand for: over more of
it the line misses a turn, and hysteresis remembers turns."""


def runs(mask: Mask) -> list[tuple[int, int]]:
    """Give the stretches where a mask is true: the first sample, and the one behind."""
    edges = np.flatnonzero(
        np.diff(np.concatenate([[False], mask, [False]]).astype(int))
    )
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))


def cannot_be_bridged(u: FloatArray) -> Mask:
    """Mark the gaps of an input that are too long for a straight line.

    Parameters
    ----------
    u : ndarray, shape (n,)
        NaN where it is missing; a few samples are there.

    Returns
    -------
    ndarray of bool, shape (n,)
        Gaps of more than a quarter of the shortest period in the band that holds 99 %
        of the input's power.
    """
    lost = ~np.isfinite(u)
    marked = np.zeros(len(u), dtype=np.bool_)
    if not lost.any():
        return marked
    there = np.flatnonzero(~lost)
    bridged = np.interp(np.arange(len(u)), there, u[there])
    fastest = summary_of(bridged, 1.0).high_hz  # in periods a sample
    for first, behind in runs(lost):
        marked[first:behind] = (behind - first) * fastest > BRIDGED_PERIODS
    return marked
