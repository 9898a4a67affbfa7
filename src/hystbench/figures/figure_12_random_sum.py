"""Figure 12: random sum of sines, the record, the GPO filter and its error."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure

from hystbench.figures import panels, style
from hystbench.figures.data import last_seconds, read_pair

# Enough to see single swings of the fastest sine, 100 Hz.
_SECONDS = 0.5


def draw(*, records: Sequence[Path], runs: Sequence[Path]) -> Figure:
    """Draw the end of the record: outputs and error over time."""
    record, output = read_pair(records, runs)
    part = last_seconds(record, _SECONDS)
    figure = Figure(figsize=(style.PAGE, 3.5))
    outputs, error = figure.subplots(2, 1, sharex=True, height_ratios=(1.8, 1))
    panels.in_time(outputs, record, output, part)
    panels.error_in_time(error, record, output, part)
    outputs.set(ylabel=style.axis_label(record.output))
    unit = style.unit_text(record.output.unit)
    error.set(ylabel=f"error ({unit})", xlabel="time (s)")
    style.letter([outputs, error])
    figure.align_ylabels()
    style.legend_above(figure, panels.handles(record, [output.run.model]))
    return figure
