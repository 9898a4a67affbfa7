"""The pictures of the page, each one an image that stands inside the page."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, NullFormatter

from hystbench.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PAGE,
    VERMILION,
    in_style,
    legend_above,
    unit_text,
)
from hystbench.gap.report.read import HoldOut
from hystbench.gap.shrink import spectra
from hystbench.record import FloatArray

#: Bars of a picture: more of them are not read.
BARS = 20
#: Records whose hold-out series are drawn.
RECORDS = 8
#: Periods of a record that are drawn large.
PERIODS = 3
#: Points of a line: more than a page has pixels.
POINTS = 1500

BEFORE, AFTER, FLOOR = VERMILION, BLUE, BLACK


@dataclass(frozen=True)
class Picture:
    """An image inside the page, and what it says where it cannot be seen."""

    source: str
    words: str


def draw(
    paint: Callable[..., None],
    *content: Any,
    words: str,
    height: float = 2.4,
    panels: tuple[int, int] = (1, 1),
) -> Picture:
    """Draw a figure as SVG, the same bytes each time."""
    with in_style():
        figure = Figure(figsize=(PAGE, height))
        axes = figure.subplots(*panels, squeeze=False)
        paint(axes if panels[0] > 1 else axes[0], *content)
        buffer = io.BytesIO()
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None})
    text = base64.b64encode(buffer.getvalue()).decode("ascii")
    return Picture(f"data:image/svg+xml;base64,{text}", words)


def bars(
    axes: Sequence[Axes],
    names: Sequence[str],
    values: Sequence[float],
    about: str,
    picked: Sequence[bool] | None = None,
) -> None:
    """Draw horizontal bars, the first on top; those that were picked are blue."""
    (panel,) = axes
    places = np.arange(len(names))
    chosen = [True] * len(names) if picked is None else picked
    colors = [BLUE if each else GREY for each in chosen]
    panel.barh(places, values, color=colors, height=0.7)
    panel.set_yticks(places, names)
    panel.invert_yaxis()
    panel.set_xlabel(about)
    panel.grid(visible=False, axis="y")
    panel.axvline(0, color=BLACK, linewidth=0.6)


def steps(
    axes: Sequence[Axes], rungs: Sequence[tuple[str, float]], floor: float, unit: str
) -> None:
    """Draw the RMS after each effect that was added, against the floor."""
    (panel,) = axes
    names, sizes = [name for name, _ in rungs], [size for _, size in rungs]
    places = np.arange(len(rungs))
    colors = [BEFORE, *[AFTER] * (len(rungs) - 1)]
    panel.bar(places, sizes, color=colors, width=0.6)
    for place, size in zip(places, sizes, strict=True):
        panel.annotate(
            f"{size:.3g}",
            (place, size),
            (0, 2),
            textcoords="offset points",
            ha="center",
        )
    panel.axhline(floor, color=FLOOR, linestyle="--", label="noise floor")
    added = [names[0], *(f"+ {name}" for name in names[1:])]
    panel.set_xticks(places, added)
    panel.set_ylabel(f"rms residual ({unit_text(unit)})")
    panel.set_ylim(0, 1.15 * max(*sizes, floor))
    panel.grid(visible=False, axis="x")
    panel.legend(loc="upper right")


def series(axes: Any, tables: Sequence[HoldOut], floor: float, unit: str) -> None:
    """Draw hold-out records: outputs, residuals and their spectra, a row each."""
    shown = unit_text(unit)
    for (outputs, residuals, spectrum), table in zip(axes, tables, strict=True):
        time = table.time_s
        left = (table.measured - table.before, table.measured - table.after)
        part = _window(table)
        outputs.plot(
            time[part],
            table.measured[part],
            color=GREY,
            linewidth=2.6,
            label="measured",
        )
        for name, values, color, line in (
            ("before", table.before, BEFORE, "--"),
            ("after", table.after, AFTER, "-"),
        ):
            outputs.plot(time[part], values[part], line, color=color, label=name)
        outputs.set_title(table.name)
        outputs.set_ylabel(f"output ({shown})")
        for values, color in zip(left, (BEFORE, AFTER), strict=True):
            residuals.plot(*_hull(time, values), color=color, linewidth=0.8)
        residuals.axhspan(-floor, floor, color=GREY, alpha=0.35, linewidth=0)
        residuals.set_title("residual, noise floor grey")
        residuals.set_ylabel(f"({shown})")
        for panel in (outputs, residuals):
            panel.set_xlabel("time (s)")
        dt = float(time[-1] - time[0]) / (len(time) - 1)
        found = spectra(*left, dt, floor)
        for power, color, line in (
            (found.before, BEFORE, "--"),
            (found.after, AFTER, "-"),
        ):
            spectrum.plot(found.frequency_hz[1:], np.sqrt(power[1:]), line, color=color)
        spectrum.axhline(np.sqrt(found.floor), color=FLOOR, linestyle=":")
        _logarithmic(spectrum, "xy")
        spectrum.set_title("residual, noise floor dotted")
        spectrum.set_xlabel("frequency (Hz)")
        spectrum.set_ylabel(f"({shown}/√Hz)")
    lines = axes[0][0].get_legend_handles_labels()[0]
    legend_above(axes[0][0].figure, lines)


def response(axes: Sequence[Axes], curve: dict[str, Any]) -> None:
    """Draw measurement over simulation, with 1 and 0 where the model is right."""
    names = (("magnitude", 1.0), ("phase", 0.0), ("coherence", 1.0))
    units = {"magnitude": "(-)", "phase": "(degrees)", "coherence": "(-)"}
    for panel, (name, right) in zip(axes, names, strict=True):
        panel.plot(curve["frequency"], curve[name], ".", color=BLUE)
        panel.axhline(right, color=BLACK, linestyle="--", linewidth=0.8)
        _logarithmic(panel, "x")
        panel.set_xlabel("frequency (Hz)")
        panel.set_ylabel(f"{name} {units[name]}")
    axes[2].set_ylim(0, 1.05)


def spectrum(axes: Any, curve: dict[str, Any], unit: str) -> None:
    """Draw amplitude densities of simulation, residual, its linear part and floor."""
    (panel,) = axes
    looks = {
        "simulated": (GREY, "-", "simulation"),
        "residual": (VERMILION, "-", "residual"),
        "linear": (BLUE, "--", "its part linear in the simulation"),
        "floor": (BLACK, ":", "noise floor"),
    }
    for name, (color, line, label) in looks.items():
        panel.plot(curve["frequency"], curve[name], line, color=color, label=label)
    _logarithmic(panel, "xy")
    panel.set_xlabel("frequency (Hz)")
    panel.set_ylabel(f"amplitude density ({unit_text(unit)}/√Hz)")
    legend_above(panel.figure, panel.get_legend_handles_labels()[0])


#: Lines of the residual: what they are, their colour, their mark.
LINES = {
    "excited": ("input's lines", BLUE, "o"),
    "odd": ("odd lines", ORANGE, "^"),
    "even": ("even lines", VERMILION, "s"),
    "either": ("odd or even", GREEN, "D"),
    "other": ("not repeating", GREY, "P"),
}


def distortion(axes: Any, found: dict[str, Any], unit: str) -> None:
    """Draw the lines of one record's residual, and what lies where in each record."""
    lines, shares = axes
    own = found["lines"]
    for name, (_, color, mark) in LINES.items():
        if name in own:
            line, sizes = own[name]["frequency"], own[name]["amplitude"]
            lines.plot(line, sizes, mark, color=color, markersize=3)
    noise = lines.axhline(own["noise"], color=FLOOR, linestyle=":", label="noise floor")
    _logarithmic(lines, "xy")
    # What is far below the noise is rounding, not a line.
    lines.set_ylim(bottom=0.1 * own["noise"])
    lines.set_title(own["record"])
    lines.set_xlabel("frequency (Hz)")
    lines.set_ylabel(f"residual's amplitude ({unit_text(unit)})")
    table = 100 * np.array([found[name] for name in LINES])
    order = np.argsort(-table.sum(axis=0), kind="stable")[:BARS]
    left, marks = np.zeros(len(order)), []
    for row, (name, (label, color, mark)) in zip(table, LINES.items(), strict=True):
        places = np.arange(len(order))
        shares.barh(places, row[order], left=left, color=color, height=0.7)
        left = left + row[order]
        if np.any(row > 0) or own.get(name, {}).get("frequency"):
            look: dict[str, Any] = {"color": color, "marker": mark, "linestyle": "none"}
            marks.append(Line2D([], [], label=label, **look))
    shares.set_yticks(np.arange(len(order)), [found["record"][i] for i in order])
    shares.invert_yaxis()
    shares.set_title("all periodic records")
    shares.set_xlabel("share of their gap (%)")
    shares.grid(visible=False, axis="y")
    legend_above(lines.figure, [*marks, noise])


def loops(
    axes: Sequence[Axes], areas: Any, coherence: Any, units: dict[str, str]
) -> None:
    """Draw the loop's area over frequency, and the gap's coherence with the input."""
    given, made = unit_text(units["input"]), unit_text(units["output"])
    if areas:
        panel = axes[0]
        frequency, error = areas["frequency"], 2 * np.array(areas["error"])
        # Behind, and larger: it is seen where the measurement lies on it.
        large: dict[str, Any] = {"color": GREY, "markersize": 6, "label": "simulation"}
        panel.plot(frequency, areas["simulated"], "s", **large)
        small: dict[str, Any] = {
            "color": BLUE,
            "markersize": 3,
            "capsize": 2,
            "label": "measurement",
        }
        panel.errorbar(frequency, areas["measured"], error, fmt="o", **small)
        panel.axhline(0, color=BLACK, linewidth=0.6)
        _logarithmic(panel, "x")
        panel.set_xlabel("frequency (Hz)")
        panel.set_ylabel(f"loop area a cycle ({given} {made})")
        panel.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2)
    if coherence:
        panel = axes[1]
        frequency = coherence["frequency"]
        panel.plot(
            frequency,
            coherence["coherence"],
            "o-",
            color=BLUE,
            markersize=3,
            label="gap with input",
        )
        panel.plot(
            frequency, coherence["chance"], ":", color=BLACK, label="chance, 1 of 20"
        )
        _logarithmic(panel, "x")
        panel.set_ylim(0, 1.05)
        panel.set_xlabel("frequency (Hz)")
        panel.set_ylabel("coherence (-)")
        panel.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2)
    for panel, there in zip(axes, (areas, coherence), strict=True):
        panel.set_visible(bool(there))


def maps(
    axes: Sequence[Axes], over_input: Any, over_rate: Any, units: dict[str, str]
) -> None:
    """Draw the residual over the input, branch by branch, and over its rate."""
    given, made = unit_text(units["input"]), unit_text(units["output"])
    if over_input:
        panel, x = axes[0], over_input["input"]
        floor = over_input["floor"]
        panel.axhspan(-floor, floor, color=GREY, alpha=0.35, linewidth=0)
        for name, color, line in (("rising", BLUE, "-"), ("falling", ORANGE, "--")):
            panel.plot(x, _numbers(over_input[name]), line, color=color, label=name)
        panel.plot(x, over_input["rms"], ":", color=BLACK, label="rms")
        panel.set_xlabel(f"input ({given})")
        panel.set_ylabel(f"residual ({made})")
        panel.set_title("by input and branch")
        panel.legend()
    if over_rate:
        panel = axes[1]
        panel.plot(over_rate["rate"], over_rate["mean"], color=GREEN, label="mean")
        panel.plot(over_rate["rate"], over_rate["rms"], ":", color=BLACK, label="rms")
        panel.set_xlabel(f"rate of the input ({given}/s)")
        panel.set_ylabel(f"residual ({made})")
        panel.set_title("by rate")
        panel.legend()


def slow(axes: Sequence[Axes], paths: Sequence[dict[str, Any]], unit: str) -> None:
    """Draw the slow path of the residual, record behind record."""
    (panel,) = axes
    start = 0.0
    for place, path in enumerate(paths):
        time = start + np.asarray(path["time"], dtype=float)
        color, mark = (BLUE, "o") if place % 2 == 0 else (ORANGE, "s")
        panel.plot(time, _numbers(path["residual"]), mark + "-", color=color)
        panel.annotate(
            path["record"],
            (start, 1),
            (2, 2),
            ("data", "axes fraction"),
            textcoords="offset points",
            va="bottom",
            fontsize=6,
            rotation=90,
        )
        start = float(time[-1]) + (float(time[0]) - start)
        panel.axvline(start, color=GREY, linewidth=0.6)
    panel.set_xlim(0, start)
    panel.set_xlabel("time, record behind record (s)")
    panel.set_ylabel(f"mean residual ({unit_text(unit)})")


def _window(table: HoldOut) -> slice:
    """A few periods where the residual before is largest."""
    count = len(table.time_s)
    power = np.abs(np.fft.rfft(table.measured - table.measured.mean()))
    line = max(1, int(np.argmax(power[1:])) + 1)
    width = min(count, max(50, PERIODS * count // line))
    total = np.concatenate([[0], np.cumsum((table.measured - table.before) ** 2)])
    first = int(np.argmax(total[width:] - total[:-width]))
    return slice(first, first + width)


def _logarithmic(panel: Axes, directions: str) -> None:
    """Make axes logarithmic, with plain numbers at the decades."""
    for axis, scale in (
        (panel.xaxis, panel.set_xscale),
        (panel.yaxis, panel.set_yscale),
    ):
        if axis.axis_name in directions:
            scale("log")
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axis.set_minor_formatter(NullFormatter())


def _hull(time: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Thin a long line to the least and the largest value of each stretch."""
    size = len(time) // (POINTS // 2)
    if size < 3:
        return time, values
    count = len(time) // size
    stretches = values[: count * size].reshape(count, size)
    ends = np.column_stack([stretches.min(axis=1), stretches.max(axis=1)])
    return np.repeat(time[: count * size : size], 2), ends.ravel()


def _numbers(values: Sequence[float | None]) -> Any:
    """Turn null into a gap of the line."""
    return np.array([np.nan if each is None else each for each in values])
