"""Judged cases as CSV, and back."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from dataclasses import astuple, fields
from pathlib import Path
from typing import Any

from hystbench.challenge.contest.score import COLUMNS, Row
from hystbench.errors import InputError
from hystbench.files import write_csv

_TRUE_FALSE = {"True": True, "False": False}


def write_rows(path: Path, rows: Iterable[Row]) -> None:
    """Write judged cases; a figure that means nothing for a case is an empty cell."""
    write_csv(path, COLUMNS, (astuple(row) for row in rows))


def read_rows(paths: Sequence[Path]) -> list[Row]:
    """Read judged cases.

    Raises
    ------
    InputError
        If a file has other columns.
    """
    kinds = {item.name: str(item.type) for item in fields(Row)}
    rows = []
    for path in paths:
        with path.open(newline="", encoding="utf-8") as stream:
            reader = csv.DictReader(stream)
            if tuple(reader.fieldnames or ()) != COLUMNS:
                raise InputError(f"{path}: expected the columns {', '.join(COLUMNS)}")
            rows += [
                Row(**{name: _value(kinds[name], text) for name, text in line.items()})
                for line in reader
            ]
    return rows


def _value(kind: str, text: str) -> Any:
    if kind == "str":
        return text
    if text == "":
        return None
    if kind.startswith("bool"):
        return _TRUE_FALSE[text]
    return int(text) if kind.startswith("int") else float(text)
