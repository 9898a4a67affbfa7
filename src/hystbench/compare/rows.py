"""Rows of the CSV files of results: read with checks, and written."""

import csv
import math
from collections.abc import Callable, Iterable, Sequence
from operator import attrgetter
from pathlib import Path
from types import NoneType
from typing import TypeVar, get_args, get_type_hints

from hystbench.errors import InputError, refuse_unknown
from hystbench.files import write_csv
from hystbench.written import check_unchanged

Item = TypeVar("Item")
_TRUTH = {"True": True, "False": False}


def read_rows(path: str | Path, columns: tuple[str, ...]) -> list[dict[str, str]]:
    """Read a CSV file that has these columns.

    Raises
    ------
    InputError
        If a column is missing, or the file is hystbench's own and was changed.
    """
    check_unchanged(path)
    with Path(path).open(encoding="utf-8", newline="") as stream:
        reader = csv.DictReader(stream)
        rows = list(reader)
    for column in columns:
        refuse_unknown(column, reader.fieldnames or (), f"{path}: no column {column!r}")
    return rows


def read_items(path: str | Path, kind: type[Item]) -> tuple[Item, ...]:
    """Read a CSV file as items of a dataclass, a column a field.

    An empty number is None where the field may be, and else infinite: it is of a
    diverged run, as is ``diverged``.

    Raises
    ------
    InputError
        If a column is missing, or a number is none.
    """
    hints = get_type_hints(kind)

    def value(name: str, text: str, row: int) -> object:
        wanted = {*get_args(hints[name])} or {hints[name]}
        if not text and NoneType in wanted:
            return None
        if float in wanted:
            try:
                return math.inf if text in ("", "diverged") else float(text)
            except ValueError as error:
                told = f"{path}: row {row}: {text!r} is not a number"
                raise InputError(told) from error
        if bool in wanted:
            refuse_unknown(text, _TRUTH, f"{path}: row {row}: {text!r} is no truth")
            return _TRUTH[text]
        return int(text) if int in wanted else text

    return tuple(
        kind(**{name: value(name, row[name], number) for name in hints})
        for number, row in enumerate(read_rows(path, tuple(hints)), 1)
    )


def names_of(kind: type) -> tuple[str, ...]:
    """Give the names of the fields of a dataclass."""
    return tuple(get_type_hints(kind))


def headers(columns: Sequence[str]) -> tuple[str, ...]:
    """Give the names of columns that may be told as ``name=attribute``."""
    return tuple(column.partition("=")[0] for column in columns)


def write_fields(
    path: str | Path,
    columns: Sequence[str],
    items: Iterable[object],
    told: Callable[[object], object] = lambda value: value,
) -> None:
    """Write a row an item.

    A column is named as an attribute of the items, or as ``name=attribute``; ``told``
    gives what is written of a value.
    """
    parted = [column.partition("=") for column in columns]
    take = [attrgetter(attribute or name) for name, _, attribute in parted]
    rows = ([told(each(item)) for each in take] for item in items)
    write_csv(path, headers(columns), rows)


def or_diverged(value: object) -> object:
    """Say of an infinite error that the run diverged."""
    return "diverged" if value == math.inf else value


def or_empty(value: object) -> object:
    """Leave the cell of an infinite error empty."""
    return None if value == math.inf else value


def four_digits(value: object) -> object:
    """Write a number with four digits, and an infinite one not at all."""
    found = or_empty(value)
    return f"{found:.4g}" if isinstance(found, float) else found
