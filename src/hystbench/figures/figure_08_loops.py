"""Figure 8: loops of the sines, the record and the GPO filter."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure

from hystbench.figures import panels, style
from hystbench.figures.data import last_cycles, read_records

_COLUMNS = 3


def draw(*, records: Sequence[Path], runs: Sequence[Path]) -> Figure:
    """Draw one panel a record, with one run on each; the last cycle is shown."""
    pairs = read_records(records, runs)
    columns = min(_COLUMNS, len(pairs))
    rows = math.ceil(len(pairs) / columns)
    figure = Figure(figsize=(style.PAGE, 0.7 + 1.85 * rows))
    grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for axes in grid.flat[len(pairs) :]:
        axes.remove()
    for axes, (record, outputs) in zip(grid.flat, pairs, strict=False):
        axes.set_title(style.signal_title(record.name))
        for output in outputs:
            panels.loop(axes, record, output, last_cycles(record, 1))
    record = pairs[0][0]
    figure.supxlabel(style.axis_label(record.input), fontsize="medium")
    figure.supylabel(style.axis_label(record.output), fontsize="medium")
    models = [output.run.model for _, outputs in pairs for output in outputs]
    style.legend_above(figure, panels.handles(record, models))
    return figure
