"""Judged cases as a data frame, read from CSV."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import astuple, fields
from pathlib import Path

import pandas as pd

from hystbench.challenge.contest.score import COLUMNS, Row
from hystbench.compare.rows import read_items
from hystbench.files import write_csv

#: An effect that is stated with a higher confidence is called confident.
CONFIDENT_ABOVE = 0.8
#: Types of columns; but for text, cells may be missing.
COLUMN_TYPES = {"str": "str", "bool": "boolean", "int": "Int64", "float": "Float64"}


def read_rows(paths: Sequence[Path]) -> pd.DataFrame:
    """Read judged cases as :func:`frame` has them.

    Raises
    ------
    InputError
        If a file lacks a column, or a number in it is none.
    """
    return frame(row for path in paths for row in read_items(path, Row))


def frame(rows: Iterable[Row]) -> pd.DataFrame:
    """Give judged cases as a data frame: a row a case, a column a field of Row.

    Figures that mean nothing for a case are missing. Added are ``stated``, the effects
    named with the confidence of each; ``given``, the same where the verdict is
    ``named``, as names beside another do not count; and ``confident``, whether one is
    stated with more than :data:`CONFIDENT_ABOVE`.
    """
    told = [astuple(row) for row in rows]
    table = pd.DataFrame(told, columns=list(COLUMNS), dtype=object)
    kinds = {item.name: str(item.type).partition(" ")[0] for item in fields(Row)}
    table = table.astype({name: COLUMN_TYPES[kind] for name, kind in kinds.items()})
    table["stated"] = table["confidences"].map(_stated).astype(object)
    named = table["verdict"] == "named"
    given = [x if y else {} for x, y in zip(table["stated"], named, strict=True)]
    table["given"] = pd.Series(given, index=table.index, dtype=object)
    table["confident"] = pd.array(list(map(sure, table["stated"])), dtype="boolean")
    return table


def write_frame(path: Path, table: pd.DataFrame) -> None:
    """Write judged cases that were read, as they were written."""
    told = table[list(COLUMNS)].astype(object)
    write_csv(path, COLUMNS, told.where(told.notna(), None).itertuples(index=False))


def _stated(confidences: str) -> dict[str, float]:
    """Give the stated confidence of each name, as a row has them."""
    parts = (word.rpartition("=") for word in confidences.split())
    return {name: float(confidence) for name, _, confidence in parts}


def sure(names: Mapping[str, float]) -> bool:
    """Tell whether a name is stated with more than :data:`CONFIDENT_ABOVE`."""
    return any(confidence > CONFIDENT_ABOVE for confidence in names.values())
