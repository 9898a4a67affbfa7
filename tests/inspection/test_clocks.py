"""Columns of time that count from a date."""

from pathlib import Path

import numpy as np
import pytest

from hystbench.formats import Table
from hystbench.inspection.clocks import clock_of, ticks_of
from hystbench.units import seconds

STEP = 0.001


@pytest.mark.parametrize(
    ("first", "unit", "said"),
    [
        # date -u -d '2024-02-29 12:00' +%s
        (1709208000.0, "s", "epoch seconds"),
        (1709208000e3, "ms", "epoch milliseconds"),
        (1709208000e6, "us", "epoch microseconds"),
        # What spreadsheets show of that date as a number, and MATLAB's datenum.
        (45351.5, "day", "serial days of Excel"),
        (739311.5, "day", "days of MATLAB's datenum"),
    ],
)
def test_what_can_only_be_a_date_is_one(first, unit, said):
    times = first + STEP / seconds("", unit) * np.arange(2000)
    assert clock_of(times) == (unit, f"{said}, from 2024-02-29 12:00:00.000 on")


@pytest.mark.parametrize("first", [0.0, 100.0, 1e5])
def test_small_numbers_are_no_dates(first):
    assert clock_of(first + STEP * np.arange(2000)) is None


@pytest.mark.parametrize("frequency", [2000.0, 1024.0, 1333.0, 48000.0])
@pytest.mark.parametrize("first", [0.0, 3.2174])
@pytest.mark.parametrize("count", [1999, 2000, 2001])
def test_of_rounded_times_the_roundest_frequency_is_told(frequency, first, count):
    digits = int(np.log10(frequency))  # the last decimal is longer than a step
    times = np.round(first + np.arange(count) / frequency, digits)
    found = ticks_of(times, "run.csv", Table(Path("run.csv"), ()))
    assert found.rounded
    assert 1 / found.step == pytest.approx(frequency, rel=1e-12)


def test_a_record_of_a_month_counts_no_days():
    assert clock_of(np.linspace(45000.0, 45030.0, 1000)) is None
