"""Loops with the output of the models: of every model, or with the error below each."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from hystbench.figures import panels, style
from hystbench.figures.data import last_cycles, read_records

#: Heights of a loop and of the error below it (inches).
_LOOP, _ERROR = 1.45, 0.75


def draw(*, records: Sequence[Path], runs: Sequence[Path]) -> Figure:
    """Draw a row a record and a column a model; the last two cycles are shown."""
    rows = read_records(records, runs)
    models = style.in_order(out.run.model for _, outputs in rows for out in outputs)
    figure = Figure(figsize=(style.PAGE, 0.7 + 1.45 * len(rows)))
    grid = figure.subplots(
        len(rows), len(models), sharex=True, sharey="row", squeeze=False
    )
    for line, (record, outputs) in zip(grid, rows, strict=True):
        line[0].set_title(style.signal_title(record.name))
        for axes, model in zip(line, models, strict=True):
            for output in outputs:
                if output.run.model == model:
                    panels.loop(axes, record, output, last_cycles(record, 2))
    record = rows[0][0]
    figure.supxlabel(style.axis_label(record.input), fontsize="medium")
    figure.supylabel(style.axis_label(record.output), fontsize="medium")
    style.legend_above(figure, panels.handles(record, models))
    return figure


def draw_with_errors(
    columns: int, *, records: Sequence[Path], runs: Sequence[Path]
) -> Figure:
    """Draw the last cycle of each record: its loop, and below it the error.

    Parameters
    ----------
    columns : int
        Loops side by side, at most.
    records, runs : sequence of Path
        Records, and one run on each.

    Returns
    -------
    Figure
        Axes in the order of the records: a loop, its error, the next loop, ...
    """
    pairs = read_records(records, runs)
    columns = min(columns, len(pairs))
    rows = math.ceil(len(pairs) / columns)
    figure = Figure(figsize=(style.PAGE, 0.7 + (_LOOP + _ERROR + 0.3) * rows))
    grid = figure.add_gridspec(2 * rows, columns, height_ratios=[_LOOP, _ERROR] * rows)
    first: dict[str, Axes] = {}

    def panel(kind: str, row: int, column: int) -> Axes:
        shared: dict[str, Any] = {
            "sharex": first.get("loop"),
            "sharey": first.get(kind),
        }
        axes: Axes = figure.add_subplot(grid[row, column], **shared)
        axes.tick_params(labelleft=column == 0)
        first.setdefault(kind, axes)
        return axes

    for place, (record, outputs) in enumerate(pairs):
        row, column = divmod(place, columns)
        loop = panel("loop", 2 * row, column)
        error = panel("error", 2 * row + 1, column)
        loop.set_title(style.signal_title(record.name))
        # The error's axis, below it, has the numbers.
        loop.tick_params(labelbottom=False)
        error.tick_params(labelbottom=place + columns >= len(pairs))
        part = last_cycles(record, 1)
        for output in outputs:
            panels.loop(loop, record, output, part)
            panels.error_over_input(error, record, output, part)
    record = pairs[0][0]
    first["loop"].xaxis.set_major_locator(MaxNLocator(3))
    for place in range(0, len(pairs), columns):
        loop, error = figure.axes[2 * place : 2 * place + 2]
        loop.set_ylabel(style.axis_label(record.output))
        error.set_ylabel(f"error ({style.unit_text(record.output.unit)})")
    figure.align_ylabels()
    figure.supxlabel(style.axis_label(record.input), fontsize="medium")
    models = [output.run.model for _, outputs in pairs for output in outputs]
    style.legend_above(figure, panels.handles(record, models))
    return figure
