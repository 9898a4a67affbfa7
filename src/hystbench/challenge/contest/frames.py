"""Judged cases as a data frame, read from CSV."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import astuple, fields
from pathlib import Path

import pandas as pd

from hystbench.challenge.contest.score import COLUMNS, Row
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

    Figures that mean nothing for a case are missing. Added are ``stated``, the effects
    named with the confidence of each; ``given``, the same where the verdict is
    ``named``, as names beside another do not count; and ``confident``, whether one is
    stated with more than :data:`CONFIDENT`.
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
    table["stated"] = table["confidences"].map(_stated).astype(object)
    named = table["verdict"] == "named"
    given = [x if y else {} for x, y in zip(table["stated"], named, strict=True)]
    table["given"] = pd.Series(given, index=table.index, dtype=object)
    table["confident"] = pd.array(list(map(sure, table["stated"])), dtype="boolean")
    return table


def _stated(confidences: str) -> dict[str, float]:
    """Give the stated confidence of each name, as a row has them."""
    parts = (word.rpartition("=") for word in confidences.split())
    return {name: float(confidence) for name, _, confidence in parts}


def sure(names: Mapping[str, float]) -> bool:
    """Tell whether a name is stated with more than :data:`CONFIDENT`."""
    return any(confidence > CONFIDENT for confidence in names.values())
