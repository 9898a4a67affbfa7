"""Rows of the CSV files of results, checked."""

from __future__ import annotations

import csv
import math
from pathlib import Path

from hystbench.errors import InputError, nearest


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
