"""Dates and times in every form, with what they are taken for."""

import datetime as dt

import numpy as np
import pytest

from hystbench.formats import read_table
from hystbench.formats.stamps import since_first
from tests.messages import message

#: Two and a half seconds over the end of a leap day.
TIMES = [
    dt.datetime(2024, 2, 29, 23, 59, 59, 250000) + dt.timedelta(seconds=0.5 * k)
    for k in range(5)
]
SECONDS = [0, 0.5, 1, 1.5, 2]
FORMS = {
    "%Y-%m-%d %H:%M:%S.%f": "year-month-day",
    "%Y-%m-%dT%H:%M:%S.%fZ": "year-month-day",
    "%Y/%m/%d %H:%M:%S.%f": "year-month-day",
    "%d.%m.%Y %H:%M:%S.%f": "day.month.year",
    "%d/%m/%Y %H:%M:%S.%f": "day-month-year",
    "%d-%m-%Y %H:%M:%S.%f": "day-month-year",
    "%m/%d/%Y %H:%M:%S.%f": "month-day-year",
    "%m/%d/%Y %I:%M:%S.%f %p": "month-day-year",
    "%d-%b-%Y %H:%M:%S.%f": "day-month-year, months by name",
    "%d %B %Y %H:%M:%S.%f": "day-month-year, months by name",
    "%H:%M:%S.%f": "times of the day",
    "%I:%M:%S.%f %p": "times of the day",
}


@pytest.mark.parametrize("comma", [False, True])
@pytest.mark.parametrize("form", FORMS)
def test_forms(form, comma):
    cells = [time.strftime(form) for time in TIMES]
    if comma:
        cells = [cell[::-1].replace(".", ",", 1)[::-1] for cell in cells]
    values, told = since_first(cells, "a.csv")
    np.testing.assert_allclose(values, SECONDS, atol=1e-9)
    assert told == FORMS[form]


def test_without_a_fraction_and_without_seconds():
    values, _ = since_first(["28.02.2024 23:59:00", "28.02.2024 23:59:07"], "")
    np.testing.assert_array_equal(values, [0, 7])
    values, _ = since_first(["28.02.2024 23:59", "", "29.02.2024 00:01"], "")
    np.testing.assert_allclose(values, [0, np.nan, 120], rtol=1e-12)


def test_an_order_that_cannot_be_told_is_refused_where_it_matters(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(
        "Time;u;y\n03/04/2024 23:59:59;1;2\n04/04/2024 00:00:00;2;3\n"
        "04/04/2024 00:00:01;3;4\n"
    )
    said = message(lambda: read_table(path))
    assert said.startswith(f"{path}: column 'Time'")
    assert "'03/04/2024 23:59:59' may be day-month-year or month-day-year" in said
    assert "2024-02-28 23:59:59" in said
    # Within a day the order changes no second.
    path.write_text("Time;u;y\n03/04/2024 10:00:00;1;2\n03/04/2024 10:00:01;2;3\n")
    table = read_table(path)
    np.testing.assert_array_equal(table.column("Time").values, [0, 1])
    assert "whatever the order" in table.notes[0]


def test_a_year_of_two_digits_is_refused():
    said = message(lambda: since_first(["28/02/24 10:00:00"], "a.csv: column 'T'"))
    assert said.startswith("a.csv: column 'T': '28/02/24 10:00:00'")


@pytest.mark.parametrize(
    "cells", [["10:15", "10:16"], ["32/13/2024 10:00:00"], ["25:00:00"], ["on"], [""]]
)
def test_what_is_none(cells):
    assert since_first(cells, "") is None
