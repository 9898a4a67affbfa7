"""A column of time: what it counts, and how evenly."""

import datetime as dt
import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hystbench.errors import InputError
from hystbench.formats import Table
from hystbench.record import FloatArray
from hystbench.samples import LARGEST_TOLERANCE, UNIFORM_TOLERANCE, tolerance_for

EARLIEST, LATEST = dt.datetime(1990, 1, 1), dt.datetime(2100, 1, 1)
"""Dates between which a computer has recorded."""
LONGEST_DAYS = 1.0
"""Longest record in days: a column of some ten thousand that runs further counts no
days."""


DIGITS = 10
"""Digits of a frequency up to which it is a number that somebody has set."""
WHOLE = 1e-3
"""What is nearer to a whole number is one."""


class _Count(NamedTuple):
    unit: str
    seconds: float
    zero: dt.datetime  # a date, and the number that it has
    number: float
    words: str


_EPOCH = dt.datetime(1970, 1, 1)
_COUNTS = (
    _Count("s", 1.0, _EPOCH, 0.0, "epoch seconds"),
    _Count("ms", 1e-3, _EPOCH, 0.0, "epoch milliseconds"),
    _Count("us", 1e-6, _EPOCH, 0.0, "epoch microseconds"),
    _Count("ns", 1e-9, _EPOCH, 0.0, "epoch nanoseconds"),
    # Excel counts a 29 February 1900 that never was: from 1 March 1900 on this is it.
    _Count("day", 86400.0, dt.datetime(1899, 12, 30), 0.0, "serial days of Excel"),
    _Count("day", 86400.0, dt.datetime(1, 1, 1), 367.0, "days of MATLAB's datenum"),
)


def clock_of(values: FloatArray) -> tuple[str, str] | None:
    """Tell what a column of time counts, where its values can only be dates.

    Parameters
    ----------
    values : ndarray, shape (n,)
        NaN where there is none.

    Returns
    -------
    tuple of (str, str) or None
        The unit, and what it is taken for, with the date of the first sample. None of
        small numbers, which count from the start of a record.
    """
    there = values[np.isfinite(values)]
    if not len(there):
        return None
    low, high = float(there.min()), float(there.max())
    for count in _COUNTS:
        first, last = (
            (limit - count.zero).total_seconds() / count.seconds + count.number
            for limit in (EARLIEST, LATEST)
        )
        too_long = count.unit == "day" and high - low > LONGEST_DAYS
        if first <= low <= high < last and not too_long:
            since = (float(there[0]) - count.number) * count.seconds
            date = count.zero + dt.timedelta(seconds=round(since, 3))
            told = date.isoformat(" ", "milliseconds")
            return count.unit, f"{count.words}, from {told} on"
    return None


@dataclass(frozen=True)
class Ticks:
    """What a column of time is like: mean step in s, unevenness, whether rounded."""

    step: float
    tolerance: float
    rounded: bool
    uneven: bool = False
    """Whether samples are to be interpolated to even times."""


def jumps_of(time: FloatArray) -> list[int]:
    """Give the samples, from 0, before which a clock jumps: rows were lost there.

    A step differs there from the usual one by more than dataset.yaml may allow.
    """
    places = np.flatnonzero(np.isfinite(time))
    steps = np.diff(time[places]) / np.diff(places)
    usual = float(np.median(steps)) if len(steps) else 0.0
    far = np.abs(steps - usual) > LARGEST_TOLERANCE * usual
    return places[1:][far].tolist() if usual > 0 else []


def ticks_of(time: FloatArray, where: str, table: Table, first: int = 0) -> Ticks:
    """Look at a column of time; what dataset.yaml cannot say is refused.

    The first sample of it may be a later one of the table. A cell without a time takes
    its step all the same.
    """
    places = np.flatnonzero(np.isfinite(time))
    if len(places) < 2:
        raise InputError(
            f"{where}: fewer than two times from {table.place(first)} on; expected a "
            "time for each sample"
        )
    there, count = time[places], places - places[0]
    moves = np.diff(there)
    steps = moves / np.diff(places)
    mean = float(there[-1] - there[0]) / int(count[-1])
    uneven = float(np.abs(steps - mean).max()) / mean if mean > 0 else np.inf
    if uneven <= UNIFORM_TOLERANCE:
        return Ticks(mean, UNIFORM_TOLERANCE, False)
    away = np.abs(there - there[0] - mean * count)
    positive = moves[moves > 0]
    quantum = float(positive.min()) if len(positive) else np.inf
    whole = np.abs(moves / quantum - np.round(moves / quantum)).max() < WHOLE
    if whole and mean > 0 and away.max() <= 1.01 * quantum and quantum > 0.5 * mean:
        step = _roundest(there, count, mean, quantum)
        return Ticks(step, UNIFORM_TOLERANCE, True)
    tolerance = tolerance_for(uneven, away.max() / mean) if mean > 0 else None
    if tolerance is not None:
        return Ticks(mean, tolerance, False)
    row = int(np.argmax(np.abs(steps - mean)))
    raise InputError(
        f"{where}: {table.place(first + int(places[row + 1]))}: a step in time of "
        f"{steps[row]:g} s where the mean is {mean:g} s; expected uniform sampling: "
        "give the parts between such steps as files of their own; if samples are even "
        f"and only their times are not, give 'sampling_frequency_hz: {1 / mean:.4g}' "
        "in place of 'time' (init: --sampling-frequency); if they were taken at these "
        "times, give 'uneven: interpolate' in 'time' (init: --uneven)"
    )


def _roundest(
    time: FloatArray, count: NDArray[np.intp], mean: float, quantum: float
) -> float:
    """Give the step of the frequency of fewest digits that rounded times allow.

    The mean where they allow none, or where a single tick tells too little. Of several
    frequencies of as few digits the one nearest to the mean is given.

    Parameters
    ----------
    time : ndarray, shape (n,)
    count : ndarray, shape (n,)
        Of steps from the first time on.
    mean, quantum : float
        Mean step, and what the times are rounded to.
    """
    span = (1 + WHOLE) * quantum
    # The first and the last time are rounded too: the mean step is off by that.
    off = span / int(count[-1])
    if mean <= off:
        return mean
    least = _first_allowed(time, count, mean - off, span)
    # Backward in time the longest step is the shortest.
    most = _first_allowed(-time, count, -mean - off, span)
    if least is None or most is None:
        return mean
    low, high = -1 / most, 1 / least
    for digits in range(1, DIGITS):
        unit = 10.0 ** (math.floor(math.log10(high)) + 1 - digits)
        fewest, largest = math.ceil(low / unit), math.floor(high / unit)
        if fewest <= largest:
            nearest = round(1 / (mean * unit))
            return 1 / (min(max(nearest, fewest), largest) * unit)
    return mean


def _first_allowed(
    time: FloatArray, count: NDArray[np.intp], step: float, span: float
) -> float | None:
    """Give the shortest step with which no two times are off by more than a span.

    Two times that are farther apart than their steps ask for a longer step: the one
    with which they are off by the span. No shorter one is allowed, so from a step that
    is too short this ends at the shortest that is. Two times that ask for a shorter
    step instead leave none: None is returned.

    Parameters
    ----------
    time : ndarray, shape (n,)
    count : ndarray, shape (n,)
        Of steps from the first time on.
    step, span : float
        A step that is too short, and how far times may be off from each other.
    """
    while True:
        away = time - step * count
        late, early = int(np.argmax(away)), int(np.argmin(away))
        steps = int(count[late] - count[early])
        if away[late] - away[early] <= span:
            return step
        if steps <= 0:
            return None
        longer = float(time[late] - time[early] - span) / steps
        if longer <= step:
            return step  # but for rounding it is there
        step = longer
