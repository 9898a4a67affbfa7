"""Putting the page together."""

from functools import partial
from typing import Any

from markupsafe import Markup

from hystbench.compare.cells import OFF_COLUMNS, ComparedCell
from hystbench.compare.measured import ERROR_COLUMNS
from hystbench.compare.rows import headers, names_of, read_items
from hystbench.figures.style import look, looks, signal_title
from hystbench.files import read_json
from hystbench.published.discrepancies import AuditRow
from hystbench.report.layout import page_environment
from hystbench.report.markup import inline, one_micro, paragraphs
from hystbench.report.picture import Link
from hystbench.report.reproduction import claims, errors, words
from hystbench.report.reproduction.read import Results, Row, Shown
from hystbench.report.table import Cell, Heading, PageTable, number, table_of

#: Columns that the page cannot do without; others are shown as they are.
_CLAIMS = ("id", "claim", "where", "kind", "basis", "verdict", "evidence")
TEMPLATE = "page.html.j2"
#: The picture of the first screen.
HEADLINE = "headline"
#: Units of the columns of tables that are shown as they are.
_HEADINGS = {"mse": "MSE", "re": "RE", "error_kind": "error"}


def page(results: Results) -> str:
    """Make the page, of the reproduction or of a measured dataset.

    Raises
    ------
    InputError
        If a file is not as it should be.
    """
    pictures = results.pictures()
    further = [
        results.shown(path, results.caption(path.stem)) for path in results.tables
    ]
    measured = results.settings["dataset"] is not None
    own = (_measured if measured else _twin)(results)
    missing = words.missing(own.pop("run"), pictures, measured)
    # the paper's figures first, by their number
    figures = sorted(
        (picture for name, picture in pictures.items() if name != HEADLINE),
        key=lambda f: (not f.name.startswith("figure"), f.name),
    )
    return one_micro(
        page_environment(__package__)
        .get_template(TEMPLATE)
        .render(
            folder=results.folder,
            dataset=results.settings["dataset"],
            measured=measured,
            missing=missing,
            headline=pictures.get(HEADLINE),
            figures=figures,
            further=further,
            more=[_as_it_is(each) for each in further],
            pictures=pictures.values(),
            **own,
        )
    )


def _twin(results: Results) -> dict[str, Any]:
    """Fill what the page says of the reproduction alone."""
    compare, folder = results.compare, results.folder
    cells = read_items(compare / "cells.csv", ComparedCell)
    ledger = results.rows("claims.csv", _CLAIMS)
    off = results.rows("off.csv", headers(OFF_COLUMNS))
    audit = results.rows("audit.csv", names_of(AuditRow))
    tables = [
        results.shown(compare / "tables" / f"table-{number}.csv")
        for number in (1, 2, 3, 4)
    ]
    on_held_out = read_json(compare / "summary.json")["claims_on_held_out"]
    halves = {cell.signal: cell.half for cell in cells}
    held = [cell for cell in errors.filter_cells(cells, "held-out") if cell.ran]

    def about(name: str) -> tuple[str, Link]:
        return results.caption(name), Link("CSV", f"{folder}/{name}.csv")

    return {
        "sentences": words.of_twin(held, on_held_out),
        "run": cells,
        "first": errors.headline_table(cells, "held-out" if held else "calibrated"),
        "near": errors.nearness_table(cells),
        **_full((compare / "verdict.md").read_text(encoding="utf-8")),
        "tables": [errors.paper_table(each, halves) for each in tables],
        "cells": errors.all_cells(cells, *about("cells")),
        "off": errors.off_table(off, *about("off")),
        "counted": claims.counts_table(ledger),
        "claims": claims.claims_table(ledger, *about("claims")),
        "audit": claims.audit_table(audit, *about("audit")),
    }


def _measured(results: Results) -> dict[str, Any]:
    """Fill what the page says of a measured dataset alone."""
    rows = results.rows("errors.csv", ERROR_COLUMNS)
    stem = f"{results.folder}/tables/errors"
    files = (
        Link("CSV", f"{results.folder}/errors.csv"),
        Link("Markdown", f"{stem}.md"),
        Link("LaTeX", f"{stem}.tex"),
    )
    return {
        "sentences": words.of_measured(results.settings["dataset"], rows),
        "run": (),
        "first": errors.measured_headline(rows),
        "errors": errors.measured_table(rows, results.caption("errors"), files),
    }


def _full(markdown: str) -> dict[str, list[Markup]]:
    """Take a verdict's list and the sentences below it, without its table."""
    parts = paragraphs(markdown)
    table = next((n for n, part in enumerate(parts) if part.startswith("|")), None)
    found: dict[str, list[Markup]] = {"listed": [], "below": []}
    for part in parts[:table]:
        kind = "listed" if part.startswith("- ") else "below"
        found[kind].append(inline(part.removeprefix("- ")))
    return found


def _as_it_is(shown: Shown) -> PageTable:
    """Show a CSV file; signals and models by their names, numbers as numbers."""

    def cell(key: str, row: Row) -> Cell | str:
        text = row[key]
        if key in numeric:
            return number(float(text)) if text else number(None)
        if key == "signal":
            return signal_title(text)
        return look(text).label if key == "model" and text in looks() else text

    keys = list(shown.rows[0]) if shown.rows else []
    numeric = {key for key in keys if all(_is_number(row[key]) for row in shown.rows)}
    columns = {
        Heading(_HEADINGS.get(key, key.replace("_", " ")), key in numeric): partial(
            cell, key
        )
        for key in keys
    }
    caption = inline(shown.caption)
    return table_of(shown.name, caption, shown.rows, columns, files=(shown.file,))


def _is_number(text: str) -> bool:
    try:
        float(text or "0")
    except ValueError:
        return False
    return True
