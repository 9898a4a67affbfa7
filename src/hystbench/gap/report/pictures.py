"""The pictures of the page, each one an image that stands inside the page."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from hystbench.figures.style import (
    BLACK,
    BLUE,
    GREY,
    PAGE,
    VERMILION,
    in_style,
    keep_layout,
    legend_above,
    plain_ticks,
    thin,
    unit_text,
)
from hystbench.gap.report.read import HoldOut
from hystbench.report.picture import svg_source
from hystbench.spectra import averaged_powers, hann

#: Bars of a picture: more of them are not read.
BARS = 20
#: Hold-out records whose series are drawn, those on which the simulator is off most.
#: Drawing is a good part of what a device costs, and more rows are not read.
MOST_RECORDS = 4
#: Periods of a record that are drawn large.
PERIODS_DRAWN = 3
#: Stretches of a line, of two points each: more than a page has pixels.
STRETCHES = 750

#: Numbers below a small picture.
TICKS = 5

BEFORE, AFTER, FLOOR = VERMILION, BLUE, BLACK


@dataclass(frozen=True)
class EmbeddedPicture:
    """An image inside the page, and what it says where it cannot be seen."""

    source: str
    words: str


def draw(
    paint: Callable[..., None],
    *content: Any,
    words: str,
    height: float = 2.4,
    width: float = PAGE,
    clear: bool = False,
    panels: tuple[int, int] = (1, 1),
) -> EmbeddedPicture:
    """Draw a figure with axes for the page."""
    with in_style():
        figure = Figure(figsize=(width, height))
        axes = figure.subplots(*panels, squeeze=False)
        paint(axes if panels[0] > 1 else axes[0], *content)
        plain_ticks(figure)
        return embedded(figure, words, clear=clear)


def embedded(figure: Figure, words: str, *, clear: bool = False) -> EmbeddedPicture:
    """Take a figure into the page as SVG, the same bytes each time."""
    buffer = io.BytesIO()
    layout = figure.get_layout_engine()
    if layout is not None:  # else all would be drawn twice, once to lay it out
        layout.execute(figure)
        keep_layout(figure)
    about = {"Date": None, "Creator": None}
    figure.savefig(buffer, format="svg", metadata=about, transparent=clear)
    return EmbeddedPicture(svg_source(buffer.getvalue()), words)


def bars(
    axes: Sequence[Axes],
    names: Sequence[str],
    values: Sequence[float],
    about: str,
    colors: Sequence[str],
) -> None:
    """Draw horizontal bars, the first on top."""
    (panel,) = axes
    places = np.arange(len(names))
    panel.barh(places, values, color=colors, height=0.65)
    panel.set_yticks(places, names)
    panel.set_ylim(max(len(names), 2) - 0.5, -0.5)  # one bar is no thicker than two
    panel.set_xlabel(about)
    panel.grid(visible=False, axis="y")
    panel.axvline(0, color=BLACK, linewidth=0.6)


def sizes(
    axes: Sequence[Axes],
    rows: Sequence[tuple[str, float | None]],
    floor: float,
    unit: str,
) -> None:
    """Draw the gap of each model as a bar, against the noise floor."""
    # A model that runs away has no size: a word stands where its bar would.
    widths = [0.0 if size is None else size for _, size in rows]
    named = [
        f"{name}\n" + ("unbounded" if size is None else f"{size:.3g} {unit_text(unit)}")
        for name, size in rows
    ]
    about = f"rms residual, all hold-out records ({unit_text(unit)})"
    bars(axes, named, widths, about, [BEFORE, *[AFTER] * (len(rows) - 1)])
    panel: Any = axes[0]
    panel.axvline(floor, color=FLOOR, linestyle="--", label=f"noise floor: {floor:.3g}")
    panel.xaxis.set_major_locator(MaxNLocator(TICKS))
    panel.set_xlim(0, 1.05 * max(*widths, floor))
    legend_above(panel.figure, panel.get_legend_handles_labels()[0])


def worst(tables: Sequence[HoldOut], count: int) -> list[HoldOut]:
    """Give so many hold-out records on which the simulator is off most, in order."""
    off = [np.mean((table.measured - table.before) ** 2) for table in tables]
    return [tables[k] for k in sorted(np.argsort(off, kind="stable")[::-1][:count])]


def glimpse(axes: Any, table: HoldOut, after: str | None) -> None:
    """Draw a few periods of a record: measured, the simulator before and after."""
    (panel,) = axes
    _outputs(panel, table, "simulator", after)
    panel.xaxis.set_major_locator(MaxNLocator(TICKS))
    legend_above(panel.figure, panel.get_legend_handles_labels()[0])


def series(axes: Any, tables: Sequence[HoldOut]) -> None:
    """Draw hold-out records: outputs, residuals and their spectra, a row each."""
    for (outputs, residuals, spectrum), table in zip(axes, tables, strict=True):
        _outputs(outputs, table, "before", "after")
        outputs.set_title(table.name)
        left_over_time(residuals, table, slice(None))
        _spectrum(spectrum, table)
    lines = axes[0][0].get_legend_handles_labels()[0]
    legend_above(axes[0][0].figure, lines)


def _outputs(panel: Axes, table: HoldOut, before: str, after: str | None) -> None:
    part = _window(table)
    time = table.time_s[part]
    behind: dict[str, Any] = {"color": GREY, "linewidth": 2.6, "label": "measured"}
    panel.plot(time, table.measured[part], **behind)
    panel.plot(time, table.before[part], "--", color=BEFORE, label=before)
    if after is not None:
        panel.plot(time, table.after[part], color=AFTER, label=after)
    panel.set_xlabel("time (s)")
    panel.set_ylabel(f"output ({unit_text(table.unit)})")


def residual(axes: Any, table: HoldOut) -> None:
    """Draw what is left of a record before and after: a stretch, and the spectrum."""
    over_time, over_frequency = axes
    left_over_time(over_time, table, _window(table))
    over_time.set_title(f"a stretch of {table.name}, noise floor grey")
    over_time.set_ylabel(f"residual ({unit_text(table.unit)})")
    _spectrum(over_frequency, table)
    over_frequency.set_title("its spectrum, noise floor dotted")
    over_frequency.set_ylabel(f"residual ({unit_text(table.unit)}/√Hz)")
    legend_above(over_time.figure, over_time.get_legend_handles_labels()[0])


def left_over_time(panel: Axes, table: HoldOut, part: slice) -> None:
    """Draw what is left of a part of a record before and after, over time."""
    for name, simulated, color in (
        ("before", table.before, BEFORE),
        ("after", table.after, AFTER),
    ):
        left = (table.measured - simulated)[part]
        look: dict[str, Any] = {"color": color, "linewidth": 0.8, "label": name}
        panel.plot(*thin(table.time_s[part], left, STRETCHES), **look)
    panel.axhspan(-table.floor, table.floor, color=GREY, alpha=0.35, linewidth=0)
    panel.set_title("residual, noise floor grey")
    panel.set_xlabel("time (s)")
    panel.set_ylabel(f"({unit_text(table.unit)})")


def _spectrum(panel: Axes, table: HoldOut) -> None:
    count = len(table.time_s)
    dt = float(table.time_s[-1] - table.time_s[0]) / (count - 1)
    size = min(count, max(16, count // 4))
    frequency = np.arange(1, size // 2 + 1) / (size * dt)
    for output, color, line in (
        (table.before, BEFORE, "--"),
        (table.after, AFTER, "-"),
    ):
        left = (table.measured - output)[None]
        power = averaged_powers(left, hann(size), size - size // 2)[0, 0, 1:].real
        panel.plot(frequency, np.sqrt(power * size * dt), line, color=color)
    # White noise of one rms has this density up to half the sampling frequency.
    panel.axhline(table.floor * np.sqrt(2 * dt), color=FLOOR, linestyle=":")
    logarithmic(panel, "xy")
    panel.set_title("residual, noise floor dotted")
    panel.set_xlabel("frequency (Hz)")
    panel.set_ylabel(f"({unit_text(table.unit)}/√Hz)")


def _window(table: HoldOut) -> slice:
    """A few periods where the residual before is largest."""
    count = len(table.time_s)
    power = np.abs(np.fft.rfft(table.measured - table.measured.mean()))
    line = max(1, int(np.argmax(power[1:])) + 1)
    width = min(count, max(50, PERIODS_DRAWN * count // line))
    total = np.concatenate([[0], np.cumsum((table.measured - table.before) ** 2)])
    first = int(np.argmax(total[width:] - total[:-width]))
    return slice(first, first + width)


def logarithmic(panel: Axes, directions: str) -> None:
    """Make axes logarithmic, with plain numbers at the decades."""
    for name in directions:
        panel.set(**{f"{name}scale": "log"})
        axis = {"x": panel.xaxis, "y": panel.yaxis}[name]
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter("")
