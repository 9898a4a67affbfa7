"""Errors as tables: ours beside the paper's, held-out signals first."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from hystbench.compare.cells import NEAR_FACTOR, ComparedCell
from hystbench.compare.summary import nearness
from hystbench.compare.tables import LEGEND, MARKS, METRIC_NAMES
from hystbench.figures.style import look, signal_title, unit_text
from hystbench.published import FILTERS, METRICS, MODELS, in_order
from hystbench.report.markup import inline
from hystbench.report.picture import Link
from hystbench.report.reproduction.read import Row, Shown
from hystbench.report.table import (
    Body,
    Cell,
    Heading,
    PageTable,
    number,
    table_in,
    table_of,
)

#: What a half is called in a table.
HALF_WORDS = {"held-out": "held out", "calibrated": "fitted"}


def filter_cells(cells: Iterable[ComparedCell], half: str) -> list[ComparedCell]:
    """List the filters' errors (MSE) of one half; RE is the same error again."""
    return [
        cell
        for cell in cells
        if cell.metric == "mse" and cell.half == half and cell.model in FILTERS
    ]


def within(cells: Iterable[ComparedCell]) -> int:
    """Count errors that are within a factor of 2 of the paper's."""
    return sum(cell.ran and cell.distance <= math.log10(NEAR_FACTOR) for cell in cells)


def headline_table(cells: Sequence[ComparedCell], half: str) -> PageTable:
    """Set ours beside the paper's: a row a signal of one half that was run."""
    half_cells = filter_cells(cells, half)
    by_key = {(cell.signal, cell.model): cell for cell in half_cells}
    signals = dict.fromkeys(cell.signal for cell in half_cells if cell.ran)
    models = [m for m in FILTERS if any(c.ran for c in half_cells if c.model == m)]
    columns = [Heading("signal")]
    for model in models:
        group = look(model).label
        columns += [Heading("paper", True, group), Heading("ours", True, group)]
    rows = []
    for signal in signals:
        row = [Cell(signal_title(signal))]
        for model in models:
            cell = by_key[signal, model]
            printed = cell.published + MARKS[cell.published_consistent]
            row += [number(float(cell.published), printed), _ours(cell)]
        rows.append(row)
    about = {
        "held-out": "Mean square error (µm²) on the held-out signals, those that the "
        "twin was not fitted to.",
        "calibrated": "Mean square error (µm²) on signals that the twin was fitted to; "
        "no held-out signal was run.",
    }[half]
    return PageTable(
        "beside-the-paper",
        about,
        columns,
        [Body(rows)],
        dense=True,
        note="Orange: off by more than a factor of 2. † ‡: the printed pair of MSE and "
        "RE cannot be true, or may not be.",
    )


def _ours(cell: ComparedCell) -> Cell:
    if not cell.ran:
        return Cell("not run", mark="quiet")
    if cell.ours is None:
        return number(math.inf)
    shown = f"{cell.ours:.4f}" if cell.ours >= 1e-3 else f"{cell.ours:.2g}"
    return number(cell.ours, shown, "" if within([cell]) else "bad")


def nearness_table(cells: Sequence[ComparedCell]) -> PageTable:
    """Tell how near ours come, by half and model; halves are never added up."""
    titles = ("errors run", "within a factor of 2", "typical factor", "worst factor")
    bodies = []
    for half, heading in (
        ("held-out", "Held-out signals: the twin was not fitted to them"),
        ("calibrated", "Signals that the twin was fitted to"),
    ):
        chosen = [c for c in cells if c.metric == "mse" and c.half == half]
        parts = {"all four filters": [c for c in chosen if c.model in FILTERS]}
        parts |= {look(m).label: [c for c in chosen if c.model == m] for m in MODELS}
        rows = [_near(name, part) for name, part in parts.items() if part]
        bodies.append(Body(rows, heading))
    return PageTable(
        "nearness",
        "How near our errors (MSE) come to the paper's, by model. The filters' errors "
        "are one-step a priori with running weights, the RDGPI model's free-run.",
        [Heading("model"), *(Heading(title, True) for title in (*titles, "diverged"))],
        bodies,
        note="The typical factor is the median over the errors, in either direction.",
    )


def _near(name: str, part: Sequence[ComparedCell]) -> list[Cell]:
    found = nearness(part)
    ran, near, worst = found["cells"], within(part), found["worst_finite"]
    return [
        Cell(name),
        number(ran, f"{ran} of {len(part)}"),
        number(near, f"{near} of {ran}") if ran else number(None),
        _factor(found["median_abs_log10_ratio"]),
        _factor(worst and worst["log10_ratio"]),
        number(found["diverged"], str(found["diverged"])),
    ]


def _factor(log10_ratio: float | None) -> Cell:
    """Make a cell of a factor in either direction, of which there may be none."""
    if log10_ratio is None:
        return number(None)
    return number(10 ** abs(log10_ratio), f"{10 ** abs(log10_ratio):.2f}")


def paper_table(shown: Shown, halves: Mapping[str, str]) -> PageTable:
    """Show a table of the paper with ours beside it; MSE and RE stand apart."""
    given = [key for key in shown.rows[0] if key not in ("signal", "error", "note")]
    columns = [Heading("signal"), Heading("twin")]
    for key in given:
        model, _, whose = key.partition(" ")
        label = look(model).label if model in MODELS else model
        columns.append(Heading(whose or key, True, label if whose else ""))
    bodies = []
    for metric in METRICS:
        name = METRIC_NAMES[metric]
        rows = sorted(
            (row for row in shown.rows if row["error"] == name),
            key=lambda row: halves[row["signal"]] != "held-out",
        )
        bodies.append(
            Body(
                [
                    [
                        Cell(signal_title(row["signal"])),
                        Cell(HALF_WORDS[halves[row["signal"]]]),
                        *(_printed(row[key]) for key in given),
                    ]
                    for row in rows
                ],
                {"mse": "Mean square error (µm²)", "re": "Relative error"}[metric],
            )
        )
    note = shown.rows[0].get("note", "")
    caption, _, legend = note.partition("†")
    stem = shown.file.href.rpartition(".")[0]
    return PageTable(
        shown.name,
        inline(caption.strip()),
        columns,
        bodies,
        files=(
            shown.file,
            Link("Markdown", f"{stem}.md"),
            Link("LaTeX", f"{stem}.tex"),
        ),
        dense=True,
        note=f"†{legend}" if legend else LEGEND,
    )


def _printed(text: str) -> Cell:
    """Make a cell of a number with a mark, or of the word that stands instead."""
    try:
        return number(float(text.rstrip("†‡")), text)
    except ValueError:
        return Cell(text, mark="bad" if text == "diverged" else "quiet")


def all_cells(cells: Sequence[ComparedCell], caption: str, file: Link) -> PageTable:
    """Show every printed error with ours, the spread of equally good twins and all."""
    ordered = sorted(cells, key=lambda cell: cell.half != "held-out")
    return _table("cells", ordered, caption, (file,))


def off_table(off: Sequence[Row], caption: str, file: Link) -> PageTable:
    """Show the errors that are off by more than a factor of 2."""
    ordered = sorted(off, key=lambda row: row["half"] != "held-out")
    return _table("off", ordered, caption, (file,))


def measured_table(
    errors: Sequence[Row], caption: str, files: tuple[Link, ...]
) -> PageTable:
    """Show the errors on a measured dataset: a row a record and model."""
    return _table("errors", errors, caption, files)


def _table(
    name: str, items: Sequence[Any], caption: str, files: tuple[Link, ...]
) -> PageTable:
    known = {
        "error": _error,
        "half": HALF_WORDS,
        "label": lambda model: look(model).label,
        "number": number,
        "title": signal_title,
        "unit": unit_text,
    }
    return table_in(__package__, name, items, known, inline(caption), files=files)


def measured_headline(errors: Sequence[Row]) -> PageTable:
    """Set the relative errors of all models side by side, a row a record."""
    by_key = {(row["signal"], row["model"]): row["re"] for row in errors}

    def shown(model: str) -> Callable[[str], Cell | str]:
        return lambda signal: (
            _error(by_key[signal, model])
            if (signal, model) in by_key
            else Cell("not run", mark="quiet")
        )

    models = in_order(row["model"] for row in errors)
    return table_of(
        "by-record",
        "Relative error of every model on every measured record. The filters' errors "
        "are one-step a priori, the RDGPI model's free-run: not the same task.",
        dict.fromkeys(row["signal"] for row in errors),
        {Heading("record"): str}
        | {Heading(look(model).label, True): shown(model) for model in models},
        dense=True,
    )


def _error(text: str) -> Cell:
    return number(float(text)) if text else number(math.inf)
