"""Judged cases as a data frame, read from CSV."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import astuple, fields
from pathlib import Path

import pandas as pd

from hystbench.challenge.contest.score import COLUMNS, Row, stated
from hystbench.errors import InputError
from hystbench.files import write_csv

#: What an effect must be stated with at least to be called confident.
CONFIDENT = 0.8


def read_rows(paths: Sequence[Path]) -> pd.DataFrame:
    """Read judged cases as :func:`frame` has them.

    Raises
    ------
    InputError
        If a file has other columns.
    """
    read = [pd.DataFrame([], columns=list(COLUMNS), dtype=str)]
    for path in paths:
        table = pd.read_csv(path, dtype=str, keep_default_na=False)
        if tuple(table.columns) != COLUMNS:
            raise InputError(f"{path}: expected the columns {', '.join(COLUMNS)}")
        read.append(table)
    return _typed(pd.concat(read, ignore_index=True))


def frame(rows: Iterable[Row]) -> pd.DataFrame:
    """Give judged cases as a data frame: a row a case, a column a field of Row.

    Figures that mean nothing for a case are missing. ``confident`` is added: whether an
    effect is named with more than :data:`CONFIDENT`.
    """
    told = [["" if v is None else str(v) for v in astuple(row)] for row in rows]
    return _typed(pd.DataFrame(told, columns=list(COLUMNS), dtype=str))


def write_frame(path: Path, table: pd.DataFrame) -> None:
    """Write judged cases that were read, as they were written."""
    told = table[list(COLUMNS)].astype(object)
    write_csv(path, COLUMNS, told.where(told.notna(), None).itertuples(index=False))


def _typed(table: pd.DataFrame) -> pd.DataFrame:
    truth = {"True": True, "False": False, "": None}
    for item in fields(Row):
        column, kind = table[item.name], str(item.type)
        if kind.startswith("bool"):
            table[item.name] = column.map(truth).astype("boolean")
        elif kind != "str":
            numbers = pd.to_numeric(column.replace("", None))
            dtype = pd.Int64Dtype() if kind.startswith("int") else pd.Float64Dtype()
            table[item.name] = numbers.astype(dtype)
    told = map(stated, table["confidences"])
    highest = [max(names.values(), default=0.0) for names in told]
    table["confident"] = pd.array([x > CONFIDENT for x in highest], dtype="boolean")
    return table
