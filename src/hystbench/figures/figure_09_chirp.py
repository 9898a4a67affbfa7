"""Figure 9: the chirp, the output of the GPO filter and its error."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure

from hystbench.figures import panels, style
from hystbench.figures.data import read_pair, thin
from hystbench.published import load_text


def draw(*, records: Sequence[Path], runs: Sequence[Path]) -> Figure:
    """Draw input, output and error over the whole record.

    The paper's two moments are marked: the smallest peak-to-peak displacement, and
    the largest, near the resonance.
    """
    record, output = read_pair(records, runs)
    everything = slice(0, len(record))
    figure = Figure(figsize=(style.PAGE, 4.8))
    given, displacement, error = figure.subplots(
        3, 1, sharex=True, height_ratios=(0.8, 1.5, 0.8)
    )
    x, y = thin(record.time, record.u)
    given.plot(x, y, color=style.BLACK, linewidth=0.7)
    panels.in_time(displacement, record, output, everything, width=0.6)
    panels.error_in_time(error, record, output, everything)

    text = load_text()
    for moment, name, align, shift in (
        (text.chirp_minimum, "smallest at", "right", -2),
        (text.chirp_resonance, "largest at", "left", 2),
    ):
        for axes in (displacement, error):
            axes.axvline(moment.time_s, color=style.BLACK, linewidth=0.8, linestyle=":")
        displacement.annotate(
            f"{name} {moment.time_s} s in the paper",
            (moment.time_s, 1),
            xycoords=("data", "axes fraction"),
            xytext=(shift, 3),
            textcoords="offset points",
            horizontalalignment=align,
            fontsize="small",
        )
    unit = style.unit_text(record.output.unit)
    given.set(ylabel=style.axis_label(record.input))
    displacement.set(ylabel=style.axis_label(record.output))
    error.set(ylabel=f"error ({unit})", xlabel="time (s)")
    style.letter([given, displacement, error])
    figure.align_ylabels()
    style.legend_above(figure, panels.handles(record, [output.run.model]))
    return figure
