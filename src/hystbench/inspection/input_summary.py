"""What kind of input a record has, how fast and large it is, and gaps in it."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from hystbench.metrics import rms
from hystbench.record import FloatArray, Mask

InputKind = Literal["sine", "sum of sines", "sweep", "steps", "ramps", "broadband"]

STILL_SHARE = 0.8
"""Share of samples at which the input stands still, of steps."""
RAMP_SPREAD = 0.25
"""Spread of the slope's size over its mean, of ramps of one slope; a sine has 0.48."""
CORNERS = 0.05
"""Share of samples at most at which ramps of several slopes bend..."""
AT_CORNERS = 0.9
"""...by so much of all that their slope changes; a sine bends by 0.08 there."""
POWER_IN_LINES = 0.95
"""Share of the power that the lines of a sine, or of a sum of sines, have."""
MOST_LINES = 20
"""Most lines of a sum of sines: more are broadband."""
LEAST_CROSSINGS = 16
"""Crossings of the mean from which the way of the frequency can be told."""
EVEN = 0.5
"""Spread of the times between crossings over their mean, in an eighth of a sweep."""
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
        return 2 * self.rate / self.span


def summary_of(u: FloatArray, dt: float) -> InputSummary:
    """Describe an input.

    Parameters
    ----------
    u : ndarray, shape (n,)
    dt : float
        Sampling interval in seconds.
    """
    power = np.square(np.abs(np.fft.rfft((u - u.mean()) * np.hanning(len(u)))))
    total = np.cumsum(power)
    edges = ((1 - POWER_SHARE) / 2 * total[-1], (1 + POWER_SHARE) / 2 * total[-1])
    low, high = np.searchsorted(total, edges) / (len(u) * dt)
    return InputSummary(
        _kind(u, power),
        max(float(low), 1 / (len(u) * dt)),
        max(float(high), 1 / (len(u) * dt)),
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


def _kind(u: FloatArray, power: FloatArray) -> InputKind:
    steps = np.abs(np.diff(u))
    reach = float(np.ptp(u))
    if np.mean(steps < 1e-6 * reach) > STILL_SHARE:
        return "steps"
    if np.std(steps) < RAMP_SPREAD * steps.mean() or _bends_at_corners(u):
        return "ramps"
    lines = _lines(power)
    if lines == 1:
        return "sine"
    if _sweeps(u):
        return "sweep"
    return "sum of sines" if lines <= MOST_LINES else "broadband"


def _bends_at_corners(u: FloatArray) -> bool:
    """Tell whether an input is straight but for a few corners."""
    bends = np.sort(np.abs(np.diff(u, 2)))
    corners = int(CORNERS * len(bends))
    return bool(np.sum(bends[len(bends) - corners :]) > AT_CORNERS * np.sum(bends))


def _lines(power: FloatArray) -> int:
    """Count the lines that hold nearly all of the power, each three bins wide."""
    left, total, count = power.copy(), float(power.sum()), 0
    while count <= MOST_LINES and left.sum() > (1 - POWER_IN_LINES) * total:
        top = int(np.argmax(left))
        left[max(top - 2, 0) : top + 3] = 0.0
        count += 1
    return count


def _sweeps(u: FloatArray) -> bool:
    """Tell whether the frequency goes one way through the record, by crossings."""
    above = u > u.mean()
    crossings = np.flatnonzero(above[1:] != above[:-1])
    if len(crossings) < LEAST_CROSSINGS:
        return False
    parts = np.array_split(np.diff(crossings), 8)
    if np.median([part.std() / part.mean() for part in parts]) > EVEN:
        return False
    gaps = np.array([part.mean() for part in parts])
    ways = np.sign(np.diff(gaps))
    one_way = np.count_nonzero(ways == ways[0]) >= len(ways) - 1
    return bool(one_way and gaps.max() > 2 * gaps.min())


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
