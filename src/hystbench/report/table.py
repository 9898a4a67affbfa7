"""Tables of a page: sorted and filtered in place, read on a phone."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial
from importlib import resources
from itertools import groupby
from typing import Any, TypeVar

from hystbench.report.picture import Link
from hystbench.templates import templates
from hystbench.yaml_files import parse_yaml

Item = TypeVar("Item")
#: What a cell is sorted by.
Key = float | str | None


@dataclass(frozen=True)
class Cell:
    """One cell."""

    shown: str
    """Text, or HTML where it is ``Markup``."""
    sort: Key = None
    """What it is sorted and filtered by; the text where it is None."""
    mark: str = ""
    """CSS class: ``good``, ``bad``, ``quiet`` or none."""


@dataclass(frozen=True)
class Heading:
    """A column: its title, whether it holds numbers, and what it stands under."""

    title: str
    numeric: bool = False
    group: str = ""

    @property
    def label(self) -> str:
        """Its whole name, where it stands alone."""
        return f"{self.group} {self.title}".strip()


@dataclass(frozen=True)
class Body:
    """Rows that are sorted among themselves, under a heading or none."""

    rows: Sequence[Sequence[Cell]]
    heading: str = ""


@dataclass(frozen=True)
class PageTable:
    """A table with its caption."""

    name: str
    """Name of the element, by which it can be linked."""
    caption: str
    """Text or ``Markup``."""
    columns: Sequence[Heading]
    bodies: Sequence[Body]
    files: tuple[Link, ...] = ()
    """Files in which it can be had."""
    filtered: tuple[str, ...] = ()
    """Titles of columns by whose values rows can be chosen."""
    cards: bool = False
    """Whether its cells hold sentences: a row is a card on a phone."""
    dense: bool = False
    """Whether it has many narrow columns."""
    note: str = ""
    """What its marks mean."""

    @property
    def count(self) -> int:
        """Rows, headings aside."""
        return sum(len(body.rows) for body in self.bodies)

    @property
    def groups(self) -> list[tuple[str, int]]:
        """Titles and how many columns are below; none where no column has one."""
        if not any(column.group for column in self.columns):
            return []
        parts = groupby(self.columns, key=lambda column: column.group)
        return [(title, len(list(columns))) for title, columns in parts]

    @property
    def choices(self) -> list[tuple[str, int, tuple[str, ...]]]:
        """Filters: title, column, and the values that are there, in their order."""
        found = []
        for place, column in enumerate(self.columns):
            if column.title in self.filtered:
                cells = (row[place] for body in self.bodies for row in body.rows)
                values = (str(c.shown if c.sort is None else c.sort) for c in cells)
                options = tuple(dict.fromkeys(value for value in values if value))
                found.append((column.title, place, options))
        return found


def number(value: float | None, shown: str = "", mark: str = "") -> Cell:
    """Make a cell of a number, with four digits where no text is given.

    None makes an empty cell, infinity the word ``diverged``.
    """
    if value is None:
        return Cell(shown, "", mark)
    if math.isinf(value):
        return Cell(shown or "diverged", "Infinity", mark or "bad")
    return Cell(shown or f"{value:.4g}", value, mark)


def table_in(
    package: str,
    name: str,
    items: Iterable[Any],
    known: Mapping[str, Any],
    caption: str = "",
    **about: Any,
) -> PageTable:
    """Make a table as ``tables.yaml`` of a package has it, with a row an item.

    Of a column the file has the title, and an expression of Jinja for what it shows of
    an item ``x``: text or a cell. Behind the title of one of numbers stands ``#``,
    before it what it stands under, with a bar between.

    Parameters
    ----------
    package, name : str
    items : iterable
    known : mapping
        Names that titles, caption and expressions use.
    caption : str
        By default that of the file.
    **about
        What else a :class:`PageTable` is told.
    """
    said = dict(_tables(package)[name])
    written = said.pop("caption", "").format(**known)
    shown: dict[Heading, Callable[[Any], Any]] = {}
    for title, text in said.pop("columns").items():
        group, _, own = title.format(**known).rpartition(" | ")
        heading = Heading(own.removesuffix(" #"), own.endswith(" #"), group)
        compute = templates(package).compile_expression(text, undefined_to_none=False)
        shown[heading] = partial(_shown, compute, known)
    return table_of(name, caption or written, items, shown, **said, **about)


def _shown(compute: Callable[..., Any], known: Mapping[str, Any], item: Any) -> Any:
    return compute(**known, x=item)


@cache
def _tables(package: str) -> dict[str, Any]:
    file = resources.files(package).joinpath("tables.yaml")
    found: dict[str, Any] = parse_yaml(file.read_text("utf-8"), "tables.yaml")
    return found


def table_of(
    name: str,
    caption: str,
    items: Iterable[Item],
    shown: Mapping[Heading, Callable[[Item], Cell | str]],
    **about: Any,
) -> PageTable:
    """Make a table with a row an item.

    Parameters
    ----------
    name, caption : str
    items : iterable
    shown : mapping
        Each column, and what it shows of an item: text or a cell.
    **about
        What else a :class:`PageTable` is told.
    """
    rows = [
        [cell if isinstance(cell, Cell) else Cell(cell) for cell in cells]
        for cells in ([show(item) for show in shown.values()] for item in items)
    ]
    return PageTable(name, caption, list(shown), [Body(rows)], **about)
