"""Small measures that several claims share."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from hystbench.record import FloatArray
from hystbench.turns import turning_places


def rank_correlation(x: Sequence[float], y: Sequence[float]) -> float:
    """Spearman's rank correlation; ties take ranks in the order given.

    One point has no trend: zero.
    """
    if len(x) < 2:
        return 0.0
    ranks = [np.argsort(np.argsort(values, kind="stable")) for values in (x, y)]
    return float(np.corrcoef(ranks[0], ranks[1])[0, 1])


def turning_points(x: FloatArray, swing: float) -> FloatArray:
    """Values at which x turns back by more than ``swing``, without its ends.

    Smaller wiggles, such as noise, are passed over.
    """
    return np.asarray(x[turning_places(x, swing)], dtype=float)


def minor_turning_points(x: FloatArray) -> int:
    """Count turns inside the range of x: those that close a minor loop.

    A turn is inside where it is farther than a tenth of the range from both
    ends of the range; turns smaller than half that are passed over.
    """
    bottom, top = float(x.min()), float(x.max())
    margin = 0.1 * (top - bottom)
    turns = turning_points(x, margin / 2)
    return int(np.sum((turns > bottom + margin) & (turns < top - margin)))


def cycles(
    u: FloatArray, y: FloatArray, dt: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Split a chirp into its whole cycles: time, frequency and range of y.

    A cycle starts where u rises through the middle of its range, from clearly below to
    clearly above it (by a twentieth of the range, so that noise starts none), on the
    straight line between the two.

    Returns
    -------
    time : ndarray, shape (cycles,)
        Middle of each cycle in seconds.
    frequency : ndarray, shape (cycles,)
        One over the length of the cycle, in Hz.
    peak_to_peak : ndarray, shape (cycles,)
        max(y) - min(y) over the cycle.
    """
    u = u - (u.max() + u.min()) / 2
    clear = np.flatnonzero(np.abs(u) > 0.05 * np.ptp(u))
    rises = np.flatnonzero((u[clear[:-1]] < 0) & (u[clear[1:]] > 0))
    below, above = clear[rises], clear[rises + 1]
    exact = (below - u[below] * (above - below) / (u[above] - u[below])) * dt
    starts = np.floor(exact / dt).astype(int)
    ranges = np.array([np.ptp(y[a : b + 1]) for a, b in pairwise(starts)], dtype=float)
    return (exact[:-1] + exact[1:]) / 2, 1 / np.diff(exact), ranges
