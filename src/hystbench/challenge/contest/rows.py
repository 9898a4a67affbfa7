"""Judged cases as CSV."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import astuple
from pathlib import Path

from hystbench.challenge.contest.score import COLUMNS, Row
from hystbench.files import write_csv


def write_rows(path: Path, rows: Iterable[Row]) -> None:
    """Write judged cases; a figure that means nothing for a case is an empty cell."""
    write_csv(path, COLUMNS, (astuple(row) for row in rows))
