"""Figures 10 to 12: the end of a record of a sum of sines, and a filter's output."""

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure

from hystbench.figures import panels, style
from hystbench.figures.data import last_seconds, read_pair


def draw_curves(
    seconds: float, *, records: Sequence[Path], runs: Sequence[Path]
) -> Figure:
    """Draw the last seconds of a record: (a) over time, (b) against the input."""
    record, output = read_pair(records, runs)
    part = last_seconds(record, seconds)
    figure = Figure(figsize=(style.PAGE, 2.7))
    time, curves = figure.subplots(1, 2, sharey=True, width_ratios=(1.7, 1))
    panels.in_time(time, record, output, part)
    panels.loop(curves, record, output, part)
    time.set(xlabel="time (s)", ylabel=style.axis_label(record.output))
    curves.set(xlabel=style.axis_label(record.input))
    style.letter([time, curves])
    style.legend_above(figure, panels.handles(record, [output.run.model]))
    return figure


def draw_errors(
    seconds: float, *, records: Sequence[Path], runs: Sequence[Path]
) -> Figure:
    """Draw the last seconds of a record: outputs and error over time."""
    record, output = read_pair(records, runs)
    part = last_seconds(record, seconds)
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
