"""Loops of every record with the output of every model."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure

from hystbench.figures import panels, style
from hystbench.figures.data import last_cycles, read_records

_CYCLES = 2


def draw(*, records: Sequence[Path], runs: Sequence[Path]) -> Figure:
    """Draw a row a record and a column a model; the last cycles are shown."""
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
                    panels.loop(axes, record, output, last_cycles(record, _CYCLES))
    record = rows[0][0]
    figure.supxlabel(style.axis_label(record.input), fontsize="medium")
    figure.supylabel(style.axis_label(record.output), fontsize="medium")
    style.legend_above(figure, panels.handles(record, models))
    return figure
