"""Text tables: CSV with any separator and decimal mark, comments, lines of remarks.

How a text is laid out is found from its rows of numbers: the separator and decimal
mark that make most of them whole rows. What stands above the first of them is the
header, a row of units, and lines that are passed over.
"""

import csv
import math
import re
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import repeat
from pathlib import Path

import numpy as np

from hystbench.errors import InputError
from hystbench.formats.stamps import since_first
from hystbench.formats.table import Column, FloatArray, Table
from hystbench.sentences import MAKE_MISSING
from hystbench.text_files import decoded

COMMENTS = ("#", "%", "//", "!", '"#')
"""What a line of comment begins with."""
LAYOUTS = (
    *((",", "."), (";", "."), (";", ","), ("\t", "."), ("\t", ",")),
    *(("|", "."), ("|", ","), (" ", "."), (" ", ","), (",", ",")),
)
"""Separator and decimal mark; a space stands for any run of spaces, and the last is
that of numbers in quotes."""
LINES_LOOKED_AT = 500
"""Lines from which the layout is found."""
NO_NUMBER = frozenset({"", "nan", "-nan", "na", "n/a", "null", "none", "#n/a", "--"})
"""What stands in a cell that has no number, in small letters."""
SIGNS = {";": "semicolons", "\t": "tabs", "|": "bars", " ": "spaces", ",": "commas"}
"""Names of separators."""

_UNIT_CELL = re.compile(r"\s*(?:\[(?P<square>[^\]]*)\]|\((?P<round>[^)]*)\))\s*")


@dataclass(frozen=True)
class Layout:
    """How a text is laid out."""

    separator: str
    decimal: str
    names: tuple[str, ...]
    """Names of the columns."""
    units: tuple[str, ...] | None
    """Units of the columns, where a row of units stands below their names."""
    first: int
    """Index of the first line of numbers."""


def read(path: Path, wanted: Collection[str] | None = None) -> Table:
    """Read a text table.

    Parameters
    ----------
    path : Path
    wanted : collection of str, optional
        Columns that must be numbers; others are not looked at. An empty cell, or one
        such as ``NaN``, is NaN in any case.

    Raises
    ------
    InputError
        If it holds no rows of numbers, a row has more cells than the header, or a cell
        of a wanted column is something else.
    """
    text, encoding = decoded(path, "a CSV file")
    notes = [] if encoding == "UTF-8" else [f"read as {encoding}"]
    lines = text.splitlines()
    layout = layout_of(lines)
    if layout is None:
        raise InputError(f"{path}: {_no_numbers(lines, wanted)}")
    rows = _rows(text, lines, layout.first)
    _check_widths(path, lines, rows, layout)
    columns = [
        k
        for k, name in enumerate(layout.names)
        if (wanted is None and name) or (wanted is not None and name in wanted)
    ]
    values, stamps = _numbers(
        path, lines, rows, layout, columns, strict=wanted is not None
    )
    found = []
    for k, column in zip(columns, values, strict=True):
        if column is None:
            notes.append(f"{layout.names[k]}: no numbers; left out")
            continue
        unit = layout.units[k] if layout.units else None
        if k in stamps:
            unit = "s"
            notes.append(
                f"{layout.names[k]}: dates and times, taken as {stamps[k]}; seconds "
                "from the first"
            )
        found.append(Column(layout.names[k], column, unit or None))
    if layout.separator != "," or layout.decimal != ".":
        comma = ", decimal commas" if layout.decimal == "," else ""
        notes.append(f"columns separated by {SIGNS[layout.separator]}{comma}")
    others = [name for name in layout.names if name and name not in (wanted or ())]
    return Table(
        path,
        tuple(found),
        {},
        tuple(notes),
        [k + 1 for k in rows],
        tuple(others) if wanted is not None else (),
    )


def _rows(text: str, lines: Sequence[str], first: int) -> Sequence[int]:
    """Give the lines that may hold numbers: not those that are empty, nor comments."""
    if all(map(str.strip, lines[first:])) and not any(map(text.count, COMMENTS)):
        return range(first, len(lines))  # most texts: no need to look line by line
    return [
        k
        for k in range(first, len(lines))
        if lines[k].strip() and not lines[k].lstrip().startswith(COMMENTS)
    ]


def layout_of(lines: Sequence[str]) -> Layout | None:
    """Find how a text is laid out; None where it has no two rows of numbers."""
    some = [
        (k, line)
        for k, line in enumerate(lines[: LINES_LOOKED_AT + 200])
        if line.strip() and not line.lstrip().startswith(COMMENTS)
    ][-LINES_LOOKED_AT:]
    # Where no row is of numbers alone, a column of words stands beside two of numbers.
    for is_row in (_is_numbers, _has_numbers):
        best: tuple[int, int, str, str] = (0, 0, "", "")
        for separator, decimal in LAYOUTS:
            widths = Counter(
                len(cells)
                for _, line in some
                if len(cells := _cells(line, separator)) > 1 and is_row(cells, decimal)
            )
            if widths:
                width, count = widths.most_common(1)[0]
                # Of equals the first is taken: commas between, points inside.
                found = (count, width, separator, decimal)
                best = max(best, found, key=lambda each: each[0])
                if best[0] == len(some):
                    break  # no other layout takes more lines than all
        if best[0]:
            break
    else:
        return None
    _, width, separator, decimal = best
    first = next(
        k
        for k, line in enumerate(lines)
        if len(cells := _cells(line, separator)) == width and is_row(cells, decimal)
    )
    # A row of data may be spoilt: it begins with a number all the same.
    above = [k for k in range(first) if lines[k].strip()]
    while above:
        cells = _cells(lines[above[-1]], separator)
        spoilt = len(cells) > 1 and _is_number(cells[0], decimal)
        if not spoilt or lines[above[-1]].lstrip().startswith(COMMENTS):
            break
        first = above.pop()
    names, units = _header(lines, above, separator, decimal, width)
    return Layout(separator, decimal, names, units, first)


def _header(
    lines: Sequence[str], above: list[int], separator: str, decimal: str, width: int
) -> tuple[tuple[str, ...], tuple[str, ...] | None]:
    """Find the names and units in the lines above the numbers."""
    rows: list[list[str]] = []
    for k in reversed(above):
        bare = lines[k].strip("\ufeff \r\n")
        for mark in COMMENTS:
            bare = bare.removeprefix(mark)
        cells = _cells(bare.strip(" "), separator)
        if separator == " " and len(cells) != width:
            cells = re.split(r"\s{2,}|\t", bare.strip())
        if len(cells) == 1:
            continue  # a remark
        if any(_is_number(cell, decimal) for cell in cells):
            break
        if separator == " " and len(cells) != width:
            continue
        rows.append([cell.strip() for cell in cells])
        if len(rows) == 2:
            break
    if not rows:
        return tuple(f"column {k}" for k in range(1, width + 1)), None
    if len(rows) == 2 and _are_units(rows[0]):
        units = [_unit(cell) for cell in rows[0]]
        # Empty cells at the end of the row of units were taken off.
        units += [""] * (len(rows[1]) - len(units))
        return tuple(rows[1]), tuple(units)
    return tuple(rows[0]), None


def _are_units(cells: Sequence[str]) -> bool:
    """Tell whether cells are units: in brackets, or short and known."""
    said = [cell for cell in cells if cell]
    if not said:
        return False
    if all(_UNIT_CELL.fullmatch(cell) for cell in said):
        return True
    from hystbench.units import is_known  # late: most texts have no such row

    return all(map(is_known, said))


def _unit(cell: str) -> str:
    found = _UNIT_CELL.fullmatch(cell)
    return (found["square"] or found["round"] or "").strip() if found else cell


def _cells(line: str, separator: str) -> list[str]:
    """Cut a line into cells, quotes and what is empty at its end taken off."""
    if separator == " ":
        return line.split()
    if '"' in line:
        cells = next(csv.reader([line], delimiter=separator, skipinitialspace=True), [])
    else:
        cells = line.split(separator)
    while len(cells) > 1 and not cells[-1].strip():
        cells.pop()
    return cells


def _is_number(cell: str, decimal: str) -> bool:
    cell = cell.strip()
    if decimal == ",":
        if "." in cell:
            return False
        cell = cell.replace(",", ".")
    try:
        return "_" not in cell and math.isfinite(float(cell))
    except ValueError:
        return False


def _is_numbers(cells: Sequence[str], decimal: str) -> bool:
    """Tell whether a row is one of numbers: none may be missing."""
    return all(_is_number(cell, decimal) for cell in cells)


def _has_numbers(cells: Sequence[str], decimal: str) -> bool:
    """Tell whether a row has two numbers or more."""
    return sum(_is_number(cell, decimal) for cell in cells) > 1


def _check_widths(
    path: Path, lines: Sequence[str], rows: Sequence[int], layout: Layout
) -> None:
    """Refuse rows of more cells than the header: decimal commas, or a lost line end."""
    separator, columns = layout.separator, len(layout.names)
    counts = map(str.count, map(lines.__getitem__, rows), repeat(separator))
    if separator != " " and max(counts, default=0) < columns:
        return
    for k in rows:
        if separator != " " and lines[k].count(separator) < columns:
            continue
        cells = len(_cells(lines[k], separator))
        if cells > columns:
            raise InputError(
                f"{path}: row {k + 1}: {cells} cells where the header has {columns}; "
                "expected as many, and points in numbers, not decimal commas"
                if separator == ","
                else f"{path}: row {k + 1}: {cells} cells where the header has "
                f"{columns}; expected as many"
            )


def _numbers(
    path: Path,
    lines: Sequence[str],
    rows: Sequence[int],
    layout: Layout,
    columns: Sequence[int],
    *,
    strict: bool,
) -> tuple[list[FloatArray | None], dict[int, str]]:
    """Read columns, and tell which hold dates and times, and in what form.

    A column that holds no numbers is None, unless that is an error.
    """
    if not columns:
        return [], {}
    separator, decimal = layout.separator, layout.decimal
    texts = [lines[k] for k in rows]
    if not any(map(str.__contains__, texts, repeat('"'))):
        plain = [x.replace(",", ".") for x in texts] if decimal == "," else texts
        try:
            table = np.loadtxt(
                plain,
                delimiter=None if separator == " " else separator,
                usecols=columns,
                comments=None,
                ndmin=2,
            )
            if not (strict and np.isinf(table).any()):
                return [np.ascontiguousarray(part) for part in table.T], {}
        except ValueError:
            pass  # a cell is empty or no number
    cut = [_cells(line, separator) for line in texts]
    found: list[FloatArray | None] = []
    stamps = {}
    for column in columns:
        said = [cells[column].strip() if column < len(cells) else "" for cells in cut]
        times = since_first(
            ["" if cell.lower() in NO_NUMBER else cell for cell in said],
            f"{path}: column {layout.names[column]!r}",
        )
        if times is not None:
            values, stamps[column] = times
            found.append(values)
            continue
        numbers = [
            _value(cell.replace(",", ".") if decimal == "," else cell, strict)
            for cell in said
        ]
        spoilt = [k for k, number in enumerate(numbers) if number is None]
        values = np.array([np.nan if x is None else x for x in numbers])
        # A column of words is none of numbers; one with a few of them is spoilt.
        words = not strict and (len(spoilt) > len(rows) / 2 or np.isnan(values).all())
        if spoilt and not words:
            cell = said[spoilt[0]]
            first_of = f" (the first of {len(spoilt)})" * (len(spoilt) > 1)
            raise InputError(
                f"{path}: row {rows[spoilt[0]] + 1}: column {layout.names[column]!r} "
                f"is {cell!r}{first_of}; expected a {_wanted(cell, decimal)}"
            )
        found.append(None if words else values)
    return found, stamps


def _value(cell: str, strict: bool) -> float | None:
    """Read a cell: NaN where it has no number, None where it is something else."""
    if cell.lower() in NO_NUMBER:
        return math.nan
    try:
        value = float(cell)
    except ValueError:
        return None
    return None if "_" in cell or (strict and math.isinf(value)) else value


def _wanted(cell: str, decimal: str) -> str:
    """Say what to do with a cell that is no number."""
    mark, name = (".", "points") if decimal == "," else (",", "commas")
    # 1,5 may be a decimal comma: without it the number would be ten times as large.
    grouped = rf"[+-]?\d{{1,3}}({re.escape(mark)}\d{{3}})+({re.escape(decimal)}\d+)?"
    if re.fullmatch(grouped, cell):
        return f"finite number, without {name} between thousands"
    return f"finite number: {MAKE_MISSING}, or take out a row that is no sample"


def _no_numbers(lines: Sequence[str], wanted: Collection[str] | None) -> str:
    """Tell what is wrong with a text without rows of numbers."""
    name = next(iter(wanted or ()), "time_s")
    if not any(line.strip() for line in lines):
        return f"empty: no column {name!r}; expected a header and rows"
    there = any(name in line for line in lines)
    lacks = "" if there else f"no column {name!r} and "
    return f"{lacks}0 rows of numbers; expected a header and at least 2 samples"
