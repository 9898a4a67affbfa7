"""What kind of input a record has, how fast and large it is, and gaps in it."""

from dataclasses import dataclass

import numpy as np

from hystbench.inspection.input_kind import InputKind, kind_of_input
from hystbench.metrics import rms
from hystbench.record import FloatArray, Mask
from hystbench.spectra import line_below, periodogram

SMALL_SWING = 0.1
"""Share of the range: a way that is shorter may be noise."""
POWER_SHARE = 0.99
"""Share of the input's power in its band."""


@dataclass(frozen=True)
class InputSummary:
    """An input in a few numbers."""

    kind: InputKind
    low_hz: float
    high_hz: float
    """Band that holds 99 % of the power of its changes about the mean."""
    low: float
    high: float
    """Range, in the input's unit."""
    rate: float
    """Rms of its rate, in its unit a second."""
    least_swing: float
    """Least way from one turn to the next, of those over a tenth of the range."""

    @property
    def span(self) -> float:
        """Peak to peak, in the input's unit."""
        return self.high - self.low

    @property
    def relative_rate(self) -> float:
        """Rms of the rate over half of the range, in 1/s."""
        return 2 * self.rate / self.span if self.span > 0 else 0.0


def summary_of(u: FloatArray, dt: float) -> InputSummary:
    """Describe an input.

    Parameters
    ----------
    u : ndarray, shape (n,)
    dt : float
        Sampling interval in seconds.
    """
    power, frequency = periodogram(u, dt)
    low, high = (
        float(frequency[line_below(power, share)])
        for share in ((1 - POWER_SHARE) / 2, (1 + POWER_SHARE) / 2)
    )
    return InputSummary(
        kind_of_input(u),
        max(low, 1 / (len(u) * dt)),
        max(high, 1 / (len(u) * dt)),
        float(u.min()),
        float(u.max()),
        rms(np.diff(u) / dt),
        _least_swing(u),
    )


def _least_swing(u: FloatArray) -> float:
    moves = np.diff(u)
    ways = np.sign(moves[moves != 0.0])
    moved = u[np.append(True, moves != 0.0)]
    turns = np.flatnonzero(ways[1:] != ways[:-1]) + 1
    swings = np.abs(np.diff(moved[turns]))
    large = swings[swings > SMALL_SWING * np.ptp(u)]
    return float(large.min()) if len(large) else float(np.ptp(u))


BRIDGED_PERIODS = 0.25
"""Share of the fastest period of an input that a straight line may stand for: over more
of it the line misses a turn, and hysteresis remembers turns."""


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
