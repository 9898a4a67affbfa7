"""Loops with the error below each: Figure 8 and the picture of the front page."""

from __future__ import annotations

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


def loops_and_errors(
    records: Sequence[Path], runs: Sequence[Path], columns: int
) -> Figure:
    """Draw the last cycle of each record: its loop, and below it the error.

    Parameters
    ----------
    records, runs : sequence of Path
        Records, and one run on each.
    columns : int
        Loops side by side, at most.

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
