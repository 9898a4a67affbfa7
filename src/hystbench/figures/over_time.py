"""Figures 9 to 12: the chirp and the sums of sines over time, and a filter's output."""

from collections.abc import Sequence
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hystbench.compare.claims.statistics import cycles
from hystbench.figures import panels, style
from hystbench.figures.data import Output, last_seconds, read_pair
from hystbench.published import load_text
from hystbench.record import FloatArray, Record

# Seconds before and after the paper's resonance: where the displacement turns, so that
# the lines of the record and of the model, a hundredth of the stroke apart, can be told
# apart, and as thin as that takes.
_BEFORE, _AFTER = 0.002, 0.001
_THIN = 1.2


def draw_chirp(*, records: Sequence[Path], runs: Sequence[Path]) -> Figure:
    """Draw input, a part of the output, its range in each cycle, and the error.

    The paper's two moments are marked: the smallest peak-to-peak displacement, and
    the largest, near the resonance. The part of the output is that around the second.
    """
    record, output = read_pair(records, runs)
    everything = slice(0, len(record))
    figure = Figure(figsize=(style.PAGE, 6.2))
    grid = figure.subplots(4, 1, height_ratios=(0.7, 1.6, 1.0, 0.8))
    given, displacement, ranges, error = grid
    for axes in (ranges, error):
        axes.sharex(given)
    x, y = style.thin(record.time, record.u)
    given.plot(x, y, color=style.BLACK, linewidth=0.7)
    part = _around_resonance(record)
    panels.in_time(displacement, record, output, part)
    for line in displacement.get_lines():
        line.set(linewidth=min(line.get_linewidth(), _THIN))
    _ranges(ranges, record, output)
    panels.error_in_time(error, record, output, everything)

    text, shown = load_text(), record.time[part]
    for moment, name, align, shift in (
        (text.chirp_minimum, "smallest at", "right", -2),
        (text.chirp_resonance, "largest at", "left", 2),
    ):
        for axes in (displacement, ranges, error):
            if axes is not displacement or shown[0] <= moment.time_s <= shown[-1]:
                axes.axvline(
                    moment.time_s, color=style.BLACK, linewidth=0.8, linestyle=":"
                )
        ranges.annotate(
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
    ranges.set(ylabel=f"peak to peak ({unit})")
    error.set(ylabel=f"error ({unit})")
    for axes in grid:
        axes.set(xlabel="time (s)")
    for axes in (given, ranges):
        axes.set(xlabel="")
        axes.tick_params(labelbottom=False)
    style.letter(list(grid))
    figure.align_ylabels()
    style.legend_above(figure, panels.handles(record, [output.run.model]))
    return figure


def _around_resonance(record: Record) -> slice:
    """Find the samples around the paper's resonance; the end of a shorter record."""
    first = load_text().chirp_resonance.time_s - _BEFORE
    count = min(round((_BEFORE + _AFTER) / record.dt) + 1, len(record))
    start = min(round(first / record.dt), len(record) - count)
    return slice(start, start + count)


def _ranges(axes: Axes, record: Record, output: Output) -> None:
    """Draw the range of each whole cycle: of the record, and of the model's output."""

    def over_time(y: FloatArray) -> tuple[FloatArray, FloatArray]:
        time, _, size = cycles(record.u[: len(y)], y, record.dt)
        return time, size

    axes.plot(*over_time(record.y), **style.BEHIND)
    if len(output.y) < len(record):
        panels.say_diverged(axes, record, output)
    else:
        axes.plot(*over_time(output.y), **style.look(output.run.model).line)


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
