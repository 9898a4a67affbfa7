"""Rows of the CSV files of results: read with checks, and written."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Sequence
from operator import attrgetter
from pathlib import Path

from hystbench.errors import InputError, nearest
from hystbench.files import write_csv


def read_rows(path: str | Path, columns: tuple[str, ...]) -> list[dict[str, str]]:
    """Read a CSV file that has these columns.

    Raises
    ------
    InputError
        If it cannot be read or a column is missing.
    """
    try:
        with Path(path).open(encoding="utf-8", newline="") as stream:
            reader = csv.DictReader(stream)
            rows = list(reader)
    except OSError as error:
        raise InputError(f"{path}: not readable ({error})") from error
    for column in columns:
        if column not in (reader.fieldnames or ()):
            known = nearest(column, reader.fieldnames or ())
            raise InputError(f"{path}: no column {column!r}; {known}")
    return rows


def finite_or_infinite(text: str, path: str | Path, row: int) -> float:
    """Read an error; an empty one means that the run diverged.

    Raises
    ------
    InputError
        If it is no number.
    """
    try:
        return float(text) if text else math.inf
    except ValueError as error:
        raise InputError(f"{path}: row {row}: {text!r} is not a number") from error


def write_fields(
    path: str | Path, columns: Sequence[str], items: Iterable[object]
) -> None:
    """Write a row an item; what is infinite is of a diverged run.

    A column is named as an attribute of the items, or as ``name=attribute``.
    """
    named = [(name, attribute or name) for name, _, attribute in _parted(columns)]
    take = [attrgetter(attribute) for _, attribute in named]
    rows = ([_told(each(item)) for each in take] for item in items)
    write_csv(path, [name for name, _ in named], rows)


def _parted(columns: Sequence[str]) -> list[tuple[str, str, str]]:
    return [column.partition("=") for column in columns]


def _told(value: object) -> object:
    return "diverged" if value == math.inf else value
