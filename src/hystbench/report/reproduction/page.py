"""Putting the page together."""

from functools import partial

from markupsafe import Markup

from hystbench.figures.style import look, looks, signal_title
from hystbench.report.layout import page_environment
from hystbench.report.markup import inline, one_micro, paragraphs
from hystbench.report.picture import Link
from hystbench.report.reproduction import claims, errors, words
from hystbench.report.reproduction.read import (
    Measured,
    Reproduction,
    ReproductionContent,
    Row,
    Shown,
)
from hystbench.report.table import Cell, Heading, PageTable, number, table_of

TEMPLATE = "page.html.j2"
#: The picture of the first screen.
HEADLINE = "headline"
#: Units of the columns of tables that are shown as they are.
_HEADINGS = {"mse": "MSE", "re": "RE", "error_kind": "error"}


def page(content: ReproductionContent) -> str:
    """Make the page, of the reproduction or of a measured dataset."""
    found = content.found
    own = (
        _measured(found, content)
        if isinstance(found, Measured)
        else _twin(found, content)
    )
    figures = {figure.name: figure for figure in content.figures}
    headline = figures.pop(HEADLINE, None)
    return one_micro(
        page_environment("hystbench.report.reproduction")
        .get_template(TEMPLATE)
        .render(
            headline=headline,
            # the paper's figures first, by their number
            figures=sorted(
                figures.values(),
                key=lambda f: (not f.name.startswith("figure"), f.name),
            ),
            more=[_as_it_is(each) for each in content.tables],
            measured=isinstance(found, Measured),
            **own,
        )
    )


def _twin(found: Reproduction, content: ReproductionContent) -> dict[str, object]:
    """Fill what the page says of the reproduction alone."""
    halves = {cell.signal: cell.half for cell in found.cells}
    held = [cell for cell in errors.filter_cells(found.cells, "held-out") if cell.ran]
    folder, told = content.compare, content.captions

    def file(name: str) -> Link:
        return Link("CSV", f"{folder}/{name}.csv")

    return {
        "title": "hystbench: a filter of generalized play operators, reproduced on a "
        "twin",
        "sentences": [words.of_errors(held), words.of_claims(found.on_held_out)],
        "source": "The paper's numbers are of a measured actuator whose data are not "
        "public. Ours are of its twin, a simulation.",
        "missing": [
            *words.not_run(found.cells),
            *words.not_drawn(words.OF_TWIN, content.figures),
        ],
        "first": errors.headline_table(
            found.cells, "held-out" if held else "calibrated"
        ),
        "near": errors.nearness_table(found.cells),
        **_full(found.verdict),
        "tables": [errors.paper_table(each, halves) for each in found.tables],
        "cells": errors.all_cells(found.cells, told["cells"], file("cells")),
        "off": errors.off_table(found.off, told["off"], file("off")),
        "counted": claims.counts_table(found.claims),
        "claims": claims.claims_table(found.claims, told["claims"], file("claims")),
        "audit": claims.audit_table(found.audit, told["audit"], file("audit")),
        "files": [
            _file(f"{folder}/verdict.md", "the verdict in full"),
            _file(f"{folder}/cells.csv", "every printed error with ours"),
            _file(f"{folder}/off.csv", "errors off by more than a factor of 2"),
            _file(f"{folder}/claims.csv", "every claim, verdict and evidence"),
            _file(f"{folder}/audit.csv", "the audit of the paper's numbers"),
            _file(f"{folder}/summary.json", "how near ours come, in numbers"),
            *(
                _file(each.file.href, "a table of the paper, ours beside it")
                for each in found.tables
            ),
            *_further_files(content),
        ],
    }


def _measured(found: Measured, content: ReproductionContent) -> dict[str, object]:
    """Fill what the page says of a measured dataset alone."""
    folder = content.compare
    stem = f"{folder}/tables/errors"
    files = (
        Link("CSV", f"{folder}/errors.csv"),
        Link("Markdown", f"{stem}.md"),
        Link("LaTeX", f"{stem}.tex"),
    )
    return {
        "title": f"hystbench: five models on the measured records of {found.name}",
        "sentences": words.of_measured(found),
        "source": "The paper has no numbers for these records, so the errors stand "
        "alone.",
        "missing": words.not_drawn(words.OF_MEASURED, content.figures),
        "first": errors.measured_headline(found.errors),
        "errors": errors.measured_table(
            found.errors, content.captions["errors"], files
        ),
        "files": [
            _file(f"{folder}/errors.csv", "every error, a row a record and model"),
            _file(f"{stem}.csv", "the same, a row a record"),
            *_further_files(content),
        ],
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


def _further_files(content: ReproductionContent) -> list[tuple[Link, str]]:
    """List the files of further tables and of figures, and what each holds."""
    return [
        *(
            _file(each.file.href, each.caption.partition(".")[0])
            for each in content.tables
        ),
        *(
            _file(link.href, f"figure, {link.label}")
            for figure in content.figures
            for link in figure.files
        ),
    ]


def _file(href: str, what: str) -> tuple[Link, str]:
    return Link(href, href), what
