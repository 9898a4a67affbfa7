"""The samples of a record: checked, made whole, their interval found."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, cast

import numpy as np

from hystbench.errors import InputError
from hystbench.formats import Column, Table, read_table
from hystbench.record import FloatArray
from hystbench.units import check_same_unit, is_known
from hystbench.yaml_files import yaml_text

#: Steps may differ from their mean by this share where dataset.yaml does not say:
#: printed times are rounded, and a clock that is off by more is no uniform clock.
UNIFORM_TOLERANCE = 0.01

#: Largest tolerance that dataset.yaml may state, as a share of a step.
LARGEST_TOLERANCE = 0.5

#: The smallest range of a channel; the largest value is one over it.
SMALLEST = 1e-30

#: An input repeats itself if two of its periods differ by no more than this share of
#: its standard deviation, rms.
UNLIKE = 0.2

OF_A_PART = frozenset(
    {"rows", "use", "name", "meant", "stands_still", "missing", "period_samples"}
)
"""What dataset.yaml may say otherwise of another part of the same measurement."""

WhereMoved = Literal["before", "elsewhere", "nowhere", "unsaid", "in none"]
"""Where a channel moves that is constant in a record: in what was just before it, or in
another record to fit; or it moves nowhere, does so by a fault for all that is known, or
is said to stand still, and does so in every record to fit."""

WHERE_MOVED: Mapping[WhereMoved, str] = {
    "before": "",
    "elsewhere": "",
    "nowhere": "a signal that moves (of a step, with a sample before it)",
    "unsaid": (
        "a signal that moves; where it really stands, say 'stands_still: [output]' of "
        "this record in dataset.yaml"
    ),
    "in none": "another record with 'use: fit' whose output moves",
}
"""What is expected of a constant channel; nothing where that is no fault."""


def record_name(entry: Mapping[str, Any]) -> str:
    """Give the name of a record: the one given, or its file's stem."""
    return str(entry.get("name", Path(entry["file"]).stem))


def check_unit(file: Path, about: Mapping[str, Any], column: Column) -> None:
    """Refuse a column whose file tells another unit, unless that is meant."""
    if column.unit is None or about.get("meant"):
        return
    if not is_known(column.unit):
        return  # words of an instrument
    check_same_unit(
        f"dataset.yaml: {about['column']!r}: unit",
        about["unit"],
        f"{file.name} itself",
        column.unit,
    )


def rows_of(
    about: Path, table: Table, entry: Mapping[str, Any], columns: Sequence[Column]
) -> slice:
    """Give the samples of a record, counted from 0.

    Raises
    ------
    InputError
        If columns differ in length, or there are no two samples.
    """
    lengths = [len(column.values) for column in columns]
    if len(set(lengths)) > 1:
        told = ", ".join(f"{column.name!r} {len(column.values)}" for column in columns)
        raise InputError(
            f"{table.path}: columns of different lengths ({told}); expected one length"
        )
    if lengths[0] < 2:
        raise InputError(
            f"{table.path}: {lengths[0]} rows; expected at least 2 samples"
        )
    first, last = entry.get("rows", (1, lengths[0]))
    if not first < last <= lengths[0]:
        raise InputError(
            f"{about}: records: {record_name(entry)}: rows: [{first}, {last}]; "
            f"expected the first and the last of its {lengths[0]} samples, from 1 on"
        )
    return slice(first - 1, last)


def whole(
    table: Table,
    column: Column,
    rows: slice,
    missing: str | None,
    described: bool = True,
) -> FloatArray:
    """Give the samples of a column, all finite.

    Of a record that no dataset.yaml describes, none is named to the user.

    Raises
    ------
    InputError
        If one is missing, and it is not said that it may be interpolated; or the first
        or last one is.
    """
    values = column.values[rows]
    lost = np.flatnonzero(~np.isfinite(values))
    if not len(lost):
        return cast(FloatArray, np.ascontiguousarray(values))
    ends = {0, len(values) - 1} & set(lost.tolist())
    if missing is None or ends or not np.isnan(values[lost]).all():
        at = int(min(ends) if missing is not None and ends else lost[0])
        shown = "'nan' or empty" if np.isnan(values[at]) else repr(str(values[at]))
        hint = ""
        if missing is not None and ends:
            hint = "; at an end nothing can be interpolated: give 'rows' without it"
        elif described:
            hint = " (for a few write 'missing: interpolate' for the record)"
        raise InputError(
            f"{table.path}: {table.place(rows.start + at)}: column {column.name!r} is "
            f"{shown}; expected a finite number{hint}"
        )
    there = np.flatnonzero(np.isfinite(values))
    return cast(FloatArray, np.interp(np.arange(len(values)), there, values[there]))


def just_before(
    entries: Sequence[Mapping[str, Any]], entry: Mapping[str, Any]
) -> list[str]:
    """Name the records of one measurement that end at the row before one begins.

    Parameters
    ----------
    entries : sequence of mapping
        What dataset.yaml says of its records.
    entry : mapping
        What it says of one of them.
    """
    first = entry.get("rows", (1, None))[0]
    measurement = {k: v for k, v in entry.items() if k not in OF_A_PART}
    return [
        record_name(other)
        for other in entries
        if other.get("rows", (1, None))[1] == first - 1
        and measurement == {k: v for k, v in other.items() if k not in OF_A_PART}
    ]


def check_moves(
    where: str, item: Mapping[str, str], values: FloatArray, moved: WhereMoved
) -> None:
    """Refuse a channel that does not move, or whose squares leave floating point.

    Parameters
    ----------
    where : str
        The file, the record and its rows, for the message.
    item : mapping
        What dataset.yaml says of the channel.
    values : ndarray, shape (n,)
    moved : str
        Where it has to move, if it is constant here.
    """
    where = f"{where}: column {item['column']!r}"
    span = float(np.ptp(values))
    if span == 0 and WHERE_MOVED[moved]:
        raise InputError(
            f"{where}: constant ({values[0]:g} {item['unit']}); expected "
            f"{WHERE_MOVED[moved]}"
        )
    largest = float(np.abs(values).max())
    if not ((span > SMALLEST or span == 0) and largest < 1 / SMALLEST):
        raise InputError(
            f"{where}: a range of {span:g} and values up to {largest:g} "
            f"{item['unit']}; expected {SMALLEST:g} to {1 / SMALLEST:g} in some unit"
        )


def between_periods(u: FloatArray, period: int) -> float:
    """Give how far one period is from the next, rms; infinity where only one fits.

    Of the nearest two: an input may be faded in and out.
    """
    rounds = u[: len(u) // period * period].reshape(-1, period)
    apart = np.sqrt(np.mean(np.diff(rounds, axis=0) ** 2, axis=1))
    return float(np.min(apart, initial=np.inf))


def check_period(place: str, period: int, u: FloatArray) -> None:
    """Refuse a period that does not fit twice, or with which no input repeats.

    A record may also be just one period, of a steady state.
    """
    if period == len(u):
        return
    if 2 * period > len(u):
        raise InputError(
            f"{place}: period_samples: {period}; expected at most {len(u) // 2}, "
            f"half of its {len(u)} samples, or all of them: one period of a steady "
            "state"
        )
    away = between_periods(u, period)
    if away > UNLIKE * float(np.std(u)):
        raise InputError(
            f"{place}: period_samples: {period}; the input differs from one period to "
            f"the next by {away / float(np.std(u)):.2g} of its standard deviation; "
            f"expected at most {UNLIKE:g}"
        )


def check_increases(table: Table, time: FloatArray, first: int) -> None:
    """Refuse a column of time that does not increase from row to row."""
    backward = np.flatnonzero(np.diff(time) <= 0)
    if len(backward):
        row = int(backward[0])
        raise InputError(
            f"{table.path}: {table.place(first + row + 1)}: time goes from "
            f"{time[row]:g} s to {time[row + 1]:g} s; expected it to increase"
        )


def tolerance_for(uneven: float, away: float) -> float | None:
    """Give the tolerance that a clock needs, with a tenth to spare; None if too large.

    Parameters
    ----------
    uneven : float
        By how much a step differs from the mean one at most, as a share of it.
    away : float
        How far a sample lies from even times at most, in steps.
    """
    if max(uneven, away) > LARGEST_TOLERANCE:
        return None
    return min(LARGEST_TOLERANCE, math.ceil(1100 * uneven) / 1000)


def sampling_interval(
    table: Table,
    time: FloatArray,
    tolerance: float,
    first: int,
    about: Mapping[str, Any] | None = None,
) -> float:
    """Mean step of a time column that increases uniformly within a tolerance.

    Parameters
    ----------
    table : Table
    time : ndarray, shape (n,)
        In seconds.
    tolerance : float
        Share of the step.
    first : int
        Row of the table, counted from 0, with which it begins.
    about : mapping, optional
        What dataset.yaml says of time; by default no dataset.yaml describes the record,
        and none is named to the user.
    """
    check_increases(table, time, first)
    steps = np.diff(time)
    dt = float(time[-1] - time[0]) / len(steps)
    # Printed times are rounded: what counts is the distance from the uniform grid.
    away = np.abs(time - time[0] - dt * np.arange(len(time)))
    step_error = np.abs(steps - dt)
    row = int(np.argmax(step_error))
    if step_error[row] > tolerance * dt or away.max() > max(tolerance, 0.5) * dt:
        hint = ""
        if about is not None:
            enough = tolerance_for(step_error.max() / dt, away.max() / dt)
            more = {"tolerance": enough} if enough else {"uneven": "interpolate"}
            kept = {k: v for k, v in about.items() if k != "tolerance"} | more
            line = yaml_text(kept, 10**6, flow=True).removesuffix("...\n").strip()
            also = ", or 'uneven: interpolate' in place of a tolerance" * bool(enough)
            hint = f"; where it is meant write 'time: {line}'{also}"
        raise InputError(
            f"{table.path}: {table.place(first + row + 1)}: a step of {steps[row]:g} s "
            f"where the mean is {dt:g} s; expected uniform sampling within "
            f"{tolerance:.3g} of a step{hint}"
        )
    return dt


def read_input(file: Path, column: str) -> tuple[float, FloatArray]:
    """Read an input of one's own: a CSV file with the columns time_s and another.

    Parameters
    ----------
    file : Path
    column : str
        Name of the input's column.

    Returns
    -------
    dt : float
        Sampling interval in seconds.
    u : ndarray, shape (n,)

    Raises
    ------
    InputError
        If a column is missing, a cell is no finite number, or sampling is not uniform.
    """
    table = read_table(file, ["time_s", column])
    columns = [table.column(name) for name in ("time_s", column)]
    rows = rows_of(file, table, {}, columns)
    time, u = (whole(table, each, rows, None, False) for each in columns)
    return sampling_interval(table, time, UNIFORM_TOLERANCE, 0), u
