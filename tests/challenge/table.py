"""The effects, their forms and ranges as a table, for docs/challenge.md."""

from __future__ import annotations

import math

from hystbench import files
from hystbench.challenge.plant.effects import IN_ACTUATOR, IN_MACHINE
from hystbench.challenge.plant.kind import Range
from hystbench.challenge.spec import GROUPS

COLUMNS = (
    *("effect", "place", "form", "parameter"),
    *("range", "unit", "limits", "right views"),
)

COLUMNS_OF_MACHINES = (
    *("effect", "place", "families", "form"),
    *("parameter", "share", "at most"),
)


def markdown_table() -> str:
    """Write every effect, form and parameter as a Markdown table.

    A range with a plus and minus sign gets its sign by a coin; one with a star is not
    multiplied by ``spread``. A number in brackets is the group with which it is left
    out.
    """
    rows = []
    for kind in IN_ACTUATOR.values():
        first = [_named(f"`{kind.name}`", kind.name), kind.place]
        views = ", ".join(kind.views)
        for form, about in kind.forms.items():
            second = _named(form, f"{kind.name}: {form}")
            for name, item in about.ranges.items() or [("", None)]:
                cells = [*first, second, "", "", "", "", views]
                if item is not None:
                    sign = "±" if item.sign else ""
                    star = "" if item.shifts else " *"
                    cells[3:7] = [
                        f"`{name}`",
                        f"{sign}{item.low:g} to {item.high:g}{star}",
                        item.unit,
                        _bounds(item),
                    ]
                rows.append(cells)
                first, second, views = ["", ""], "", ""
    return files.markdown_table(COLUMNS, rows) + "\n"


def markdown_table_of_machines() -> str:
    """Write every effect of machines, its families, forms and shares as a table."""
    rows = []
    for kind in IN_MACHINE.values():
        name = _named(f"`{kind.name}`", kind.name)
        first = [name, kind.place, ", ".join(kind.families)]
        for form, law in kind.forms.items():
            second = _named(form, f"{kind.name}: {form}")
            for name, item in law.ranges.items():
                sign = "±" if item.sign else ""
                span = f"{sign}{item.low:g} to {item.high:g} {item.unit}"
                rows.append([*first, second, f"`{name}`", span, f"{item.most:g}"])
                first, second = ["", "", ""], ""
    return files.markdown_table(COLUMNS_OF_MACHINES, rows) + "\n"


def _named(shown: str, name: str) -> str:
    """Add the group with which it is left out, if there is one."""
    within = [n for n, item in GROUPS.items() if name in item.unlisted + item.forms]
    return f"{shown} ({within[0]})" if within else shown


def _bounds(item: Range) -> str:
    """Say between which values a number is kept; nothing where none is set."""
    if math.isfinite(item.most):
        return f"{item.least:g} to {item.most:g}"
    return f"{item.least:g} or more" if item.least else ""
