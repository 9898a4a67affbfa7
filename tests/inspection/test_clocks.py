"""Columns of time that count from a date."""

import time
from pathlib import Path

import numpy as np
import pytest

from hystbench.errors import InputError
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


def ticks(times):
    return ticks_of(np.asarray(times), "run.csv", Table(Path("run.csv"), ()))


def test_times_that_no_one_frequency_explains_keep_their_mean_step():
    step = 0.00137
    count = np.arange(400.0)
    count[[100, 200]] += 1, -1  # a sample that came late, and one that came early
    started = time.perf_counter()
    assert ticks(step * count).step == pytest.approx(step, rel=1e-9)
    assert time.perf_counter() - started < 1


@pytest.mark.parametrize("samples", [1000, 1400])
def test_a_single_tick_leaves_the_mean_step(samples):
    times = np.floor(np.arange(samples) / 999)  # whole seconds at about 1 kHz
    assert ticks(times).step == pytest.approx(1 / (samples - 1), rel=1e-9)


def test_a_cell_without_a_time_takes_its_step_too():
    times = STEP * np.arange(500)
    times[200] = np.nan
    found = ticks(times)
    assert not found.rounded
    assert found.step == pytest.approx(STEP, rel=1e-9)


def test_of_rounded_times_one_may_be_missing():
    times = np.round(np.arange(2000) / 2000, 3)
    times[700:703] = np.nan
    assert 1 / ticks(times).step == pytest.approx(2000, rel=1e-12)


def test_the_row_of_a_wrong_step_is_told_below_cells_without_a_time():
    times = STEP * np.arange(60)
    times[10] = np.nan
    times[40:] += 1
    with pytest.raises(InputError, match=r"sample 41: a step in time of 1\.001 s"):
        ticks(times)


def test_a_record_of_a_month_counts_no_days():
    assert clock_of(np.linspace(45000.0, 45030.0, 1000)) is None
