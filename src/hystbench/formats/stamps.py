"""Dates and times in a text, as seconds from the first, and what they were taken for.

Read are ISO 8601 (``2024-02-28T23:59:59.5+01:00``), the year first or last with any of
``.``, ``/`` and ``-`` between, months by their English names (``28-Feb-2024``), and
times of the day alone (``23:59:59,5``).
"""

import re
from collections.abc import Sequence

import numpy as np

from hystbench.errors import InputError
from hystbench.formats.table import FloatArray, as_numbers

DAY_S = 86400.0
MONTHS = (
    *("jan", "feb", "mar", "apr", "may", "jun"),
    *("jul", "aug", "sep", "oct", "nov", "dec"),
)
_CLOCK = (
    r"(?P<hour>\d{1,2}):(?P<minute>\d\d)(?::(?P<second>\d\d)(?:[.,](?P<part>\d+))?)?"
    r"(?:\s?(?P<half>[AaPp])\.?[Mm]\.?)?"
)
_TIME_OF_DAY = re.compile(_CLOCK)
_STAMP = re.compile(
    r"(?P<one>\d{4}|\d{1,2})(?P<mark>[./ -])(?P<two>\d{1,2}|[A-Za-z]{3,9})(?P=mark)"
    rf"(?P<three>\d{{4}}|\d{{1,2}})(?:T|,?\s+){_CLOCK}\s?(?P<zone>Z|[+-]\d\d:?\d\d)?"
)


def since_first(cells: Sequence[str], place: str) -> tuple[FloatArray, str] | None:
    """Read a column of dates and times.

    Parameters
    ----------
    cells : sequence of str
        Empty where there is none.
    place : str
        File and column, for messages.

    Returns
    -------
    tuple of (ndarray, str) or None
        Seconds from the first, NaN where a cell is empty, and what the cells were taken
        for. None where one of them is no date and time.

    Raises
    ------
    InputError
        If it cannot be told which number is the day and which the month, or a year has
        two digits.
    """
    there = [cell for cell in cells if cell]
    if not there:
        return None
    for form, read in ((_TIME_OF_DAY, _times_of_day), (_STAMP, _dates)):
        found = [form.fullmatch(cell) if cell else None for cell in cells]
        if all(each for each, cell in zip(found, cells, strict=True) if cell):
            return read(found, place)
    return None


def _times_of_day(
    found: Sequence[re.Match[str] | None], place: str
) -> tuple[FloatArray, str] | None:
    if any(each is not None and each["second"] is None for each in found):
        return None  # hours and minutes, or minutes and seconds
    times = np.array([np.nan if each is None else _second(each) for each in found])
    known = np.flatnonzero(np.isfinite(times))
    if times[known].max() >= DAY_S:
        return None
    # A clock that goes back by half a day or more has passed midnight.
    passed = np.cumsum(np.diff(times[known], prepend=times[known[0]]) < -DAY_S / 2)
    times[known] += DAY_S * passed
    return times - times[known[0]], "times of the day"


def _second(each: re.Match[str]) -> float:
    """Give the second of the day."""
    part = float(f"0.{each['part'] or 0}")
    return 3600 * _hour(each) + 60 * int(each["minute"]) + int(each["second"]) + part


def _hour(each: re.Match[str]) -> int:
    hour = int(each["hour"])
    if each["half"] is None:
        return hour
    return hour % 12 + 12 * (each["half"].lower() == "p")


def _dates(
    found: Sequence[re.Match[str] | None], place: str
) -> tuple[FloatArray, str] | None:
    stamps = [each for each in found if each is not None]
    firsts = {len(each["one"]) == 4 for each in stamps}
    lasts = {len(each["three"]) == 4 for each in stamps}
    if firsts == {False} and lasts == {False}:
        raise InputError(
            f"{place}: {stamps[0][0]!r} has a year of two digits; expected four, as in "
            "2024-02-28 23:59:59"
        )
    if len(firsts) > 1 or len(lasts) > 1:
        return None
    if firsts == {True}:
        orders = {"year-month-day": ("one", "two", "three")}
    elif any(each["two"].isalpha() for each in stamps):
        orders = {"day-month-year, months by name": ("three", "two", "one")}
    else:
        orders = {
            "day-month-year": ("three", "two", "one"),
            "month-day-year": ("three", "one", "two"),
        }
    ways = {told: _seconds(found, order) for told, order in orders.items()}
    possible = {told: values for told, values in ways.items() if values is not None}
    # Points stand between day, month and year alone.
    if stamps[0]["mark"] == "." and "day-month-year" in possible:
        return possible["day-month-year"], "day.month.year"
    if len(possible) == 2:
        one, other = possible.values()
        if not np.array_equal(one, other, equal_nan=True):
            raise InputError(
                f"{place}: {stamps[0][0]!r} may be day-month-year or month-day-year; "
                "expected year-month-day, as in 2024-02-28 23:59:59, or months by name"
            )
        return one, "dates of one day, whatever the order of day and month"
    return next(((values, told) for told, values in possible.items()), None)


def _seconds(
    found: Sequence[re.Match[str] | None], order: tuple[str, str, str]
) -> FloatArray | None:
    """Read dates whose year, month and day are these groups; None of no such day."""
    import pandas as pd  # late: a third of a second

    year, month, day = order
    said = [
        ""
        if each is None
        else f"{each[year]}-{_month(each[month]):02d}-{int(each[day]):02d}T"
        f"{_hour(each):02d}:{each['minute']}:{each['second'] or '00'}"
        f".{each['part'] or 0}{each['zone'] or ''}"
        for each in found
    ]
    try:
        times = pd.to_datetime(said, format="ISO8601", utc=True)
    except ValueError:
        return None  # no day or hour of that number
    return as_numbers(times.tz_localize(None).to_numpy())


def _month(text: str) -> int:
    """Give the number of a month; 0, which is none, of another word."""
    if text.isdigit():
        return int(text)
    name = text[:3].lower()
    return MONTHS.index(name) + 1 if name in MONTHS else 0
