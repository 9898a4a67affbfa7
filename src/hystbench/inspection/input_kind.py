"""What kind of signal an input is: few rules, each of what defines the kind.

- Steps stand still nearly always.
- Ramps are straight between corners, also where a filter has rounded the corners.
- A sweep's frequency goes one way through the record.
- A sine, or a sum of sines, is a few lines that stay the same through the record: what
  they are in one half predicts the other. What comes back to itself long after has
  lines too, however many.
- All else is broadband.
"""

from itertools import pairwise
from typing import Literal

import numpy as np

from hystbench.gap.thresholds import MOST
from hystbench.periods import differences
from hystbench.record import FloatArray
from hystbench.spectra import line_below
from hystbench.turns import turning_places

InputKind = Literal["sine", "sum of sines", "sweep", "steps", "ramps", "broadband"]

STILL_SHARE = 0.8
"""Share of samples at which the input stands still, of steps."""
RAMP_SPREAD = 0.25
"""Spread of the slope's size over its mean, of ramps of one slope; a sine has 0.48."""
CORNERS = 0.05
"""Share of samples at most at which ramps of several slopes bend..."""
AT_CORNERS = 0.9
"""...by so much of all that their slope changes; a sine bends by 0.08 there."""
ROUNDED = 0.1
"""Share of the way between two turns, at either end, that a filter may have rounded."""
AS_STEEP = 0.8
"""Least slope over the largest, of the three thirds of a straight way; a sine has 0.67
between what may be rounded."""
SHORTEST_WAY = 9
"""Samples of a way at least, to tell if it is straight."""
TURN = 0.1
"""Share of the range by which an input goes back where it has turned: less is noise."""
POWER_IN_LINES = 0.95
"""Share of the power that the lines of a sine, or of a sum of sines, have."""
MOST_LINES = 20
"""Most lines of a sum of sines that does not come back to itself."""
PREDICTED = 0.75
"""Share of the power of one half that lines predict with what they are in the other:
the larger part of the rms is not missed."""
LONG = 4
"""Parts of a record, of which one is long: noise of a band forgets itself before."""
ALIKE = 0.1
"""Half the mean square, of the variance, by which an input may differ from itself."""
SAMPLES = 2000
"""Samples of a half that are looked at: enough for so few lines."""
PARTS, FEWEST_PARTS = 8, 6
"""Parts in which the way of the frequency is looked at; of fewer chance tells too
much."""
EVEN = 0.15
"""Spread of the times between crossings over their mean, in a part of a sweep: its
frequency moves little there. Of noise it is a half."""
SWEPT = 1.5
"""Ratio of the largest frequency of a sweep to the least."""
LOUD_SHARE = 0.995
"""Share of the power below the frequency from which on all is taken for noise."""


def kind_of_input(u: FloatArray) -> InputKind:
    """Tell the kind of an input.

    Parameters
    ----------
    u : ndarray, shape (n,)
    """
    steps = np.abs(np.diff(u))
    reach = float(np.ptp(u))
    if np.mean(steps <= 1e-6 * reach) > STILL_SHARE:
        return "steps"
    if np.std(steps) < RAMP_SPREAD * steps.mean() or _bends_at_corners(u):
        return "ramps"
    if _straight_between_turns(u):
        return "ramps"
    about = u - u.mean()
    if _sweeps(about):
        return "sweep"
    frequencies = _lines(about)
    if len(frequencies) == 1:
        return "sine"
    if len(frequencies) and _stay(about, frequencies):
        return "sum of sines"
    return "sum of sines" if _comes_back(u) else "broadband"


def _bends_at_corners(u: FloatArray) -> bool:
    """Tell whether an input is straight but for a few corners."""
    bends = np.sort(np.abs(np.diff(u, 2)))
    corners = int(CORNERS * len(bends))
    return bool(np.sum(bends[len(bends) - corners :]) > AT_CORNERS * np.sum(bends))


def _straight_between_turns(u: FloatArray) -> bool:
    """Tell whether an input goes straight from turn to turn, but for rounded ends.

    A way counts by how far it goes: of a short one noise hides the slope. So most of
    them are to be straight, and so is their mean.
    """
    turns = [0, *turning_places(u, TURN * float(np.ptp(u))), len(u) - 1]
    far = straight = told = 0.0
    mean = np.zeros(3)
    for first, last in pairwise(turns):
        goes = float(u[last] - u[first])
        far += abs(goes)
        rounded = int(np.ceil(ROUNDED * (last - first)))
        way = u[first + rounded : last + 1 - rounded]
        if len(way) < SHORTEST_WAY:
            continue
        slopes = np.array([_slope(third) for third in np.array_split(way, 3)])
        sizes = np.sign(goes) * slopes
        mean += (last - first) * sizes
        told += abs(goes)
        straight += abs(goes) * bool(sizes.min() > AS_STEEP * sizes.max())
    as_steep = bool(mean.min() > AS_STEEP * mean.max())
    return as_steep and told > MOST * far and straight > MOST * told


def _slope(values: FloatArray) -> float:
    """Give the slope of the straight line that fits samples best."""
    place = np.arange(len(values)) - (len(values) - 1) / 2
    return float(place @ values / (place @ place))


def _lines(about: FloatArray) -> FloatArray:
    """Find the lines that hold nearly all of the power, in cycles a sample.

    The strongest line of what is left is taken, five bins wide, till enough is in
    lines; none is returned where too many would be needed.
    """
    n = len(about)
    power = np.square(np.abs(np.fft.rfft(about * np.hanning(n))))
    left, total = power.copy(), float(power.sum())
    found: list[float] = []
    while left.sum() > (1 - POWER_IN_LINES) * total:
        if len(found) == MOST_LINES:
            return np.zeros(0)
        top = int(np.argmax(left))
        found.append((top + _beside(power, top)) / n)
        left[max(top - 2, 0) : top + 3] = 0.0
    return np.array(found)


def _beside(power: FloatArray, top: int) -> float:
    """Give how far a line is from its largest bin, by a parabola of logarithms."""
    if not 0 < top < len(power) - 1:
        return 0.0
    near = power[top - 1 : top + 2]
    low, middle, high = np.log(np.maximum(near, 1e-300))
    bend = low - 2 * middle + high
    return float(np.clip(0.5 * (low - high) / bend, -0.5, 0.5)) if bend < 0 else 0.0


def _stay(about: FloatArray, frequencies: FloatArray) -> bool:
    """Tell whether lines are in one half of a record what they are in the other.

    Samples at random do, as many as tell it.
    """
    half = len(about) // 2
    rng = np.random.default_rng(0)
    halves = []
    for first, behind in ((0, half), (half, len(about))):
        few = rng.permutation(np.arange(first, behind))[:SAMPLES]
        angle = 2 * np.pi * np.outer(few, frequencies)
        table = [np.cos(angle), np.sin(angle), np.ones((len(few), 1))]
        halves.append((np.hstack(table), about[few]))
    missed = whole = 0.0
    for (known, given), (other, wanted) in (halves, halves[::-1]):
        amplitudes = np.linalg.lstsq(known, given, rcond=1e-6)[0]
        missed += float(np.mean((wanted - other @ amplitudes) ** 2))
        whole += float(np.mean(wanted**2))
    return missed < (1 - PREDICTED) * whole


def _comes_back(u: FloatArray) -> bool:
    """Tell whether an input comes back to itself long after, so consists of lines."""
    apart = differences(u)
    return bool(np.any(apart[len(u) // LONG :] < ALIKE))


def _sweeps(about: FloatArray) -> bool:
    """Tell whether the frequency goes one way through the record, by crossings."""
    smooth = _without_noise(about)
    above = smooth > 0.0
    before = np.flatnonzero(above[1:] != above[:-1])
    rise = smooth[before + 1] - smooth[before]
    gaps = np.diff(before - smooth[before] / rise)
    count = min(PARTS, len(gaps) // 2)
    if count < FEWEST_PARTS:
        return False
    parts = np.array_split(gaps, count)
    if np.median([part.std() / part.mean() for part in parts]) > EVEN:
        return False
    means = np.array([part.mean() for part in parts])
    ways = np.sign(np.diff(means))
    most = max(np.count_nonzero(ways > 0), np.count_nonzero(ways < 0))
    one_way = most >= len(ways) - (count == PARTS)
    return bool(one_way and means.max() > SWEPT * means.min())


def _without_noise(about: FloatArray) -> FloatArray:
    """Take off what lies above the frequencies that hold nearly all of the power."""
    spectrum = np.fft.rfft(about)
    spectrum[line_below(np.abs(spectrum) ** 2, LOUD_SHARE) + 1 :] = 0.0
    return np.fft.irfft(spectrum, len(about))
