"""Outputs over time beside the hysteresis curves: Figures 10 and 11."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure

from hystbench.figures import panels, style
from hystbench.figures.data import last_seconds, read_pair


def outputs_and_curves(
    records: Sequence[Path], runs: Sequence[Path], seconds: float
) -> Figure:
    """Draw the end of a record: (a) over time, (b) against the input.

    Parameters
    ----------
    records, runs : sequence of Path
        One record and the one run on it.
    seconds : float
        How much of the end is shown.
    """
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
