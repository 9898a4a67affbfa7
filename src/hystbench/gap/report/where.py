"""The pictures of where the gap is: what curves.json holds, drawn."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.lines import Line2D

from hystbench.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    VERMILION,
    legend_above,
    unit_text,
)
from hystbench.gap.report.pictures import BARS, FLOOR, logarithmic


def response(axes: Sequence[Axes], curve: dict[str, Any]) -> None:
    """Draw measurement over simulation, with 1 and 0 where the model is right."""
    names = (("magnitude", 1.0), ("phase", 0.0), ("coherence", 1.0))
    units = {"magnitude": "(-)", "phase": "(degrees)", "coherence": "(-)"}
    for panel, (name, right) in zip(axes, names, strict=True):
        panel.plot(curve["frequency"], curve[name], ".", color=BLUE)
        panel.axhline(right, color=BLACK, linestyle="--", linewidth=0.8)
        logarithmic(panel, "x")
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
    logarithmic(panel, "xy")
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
    logarithmic(lines, "xy")
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
        logarithmic(panel, "x")
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
        logarithmic(panel, "x")
        panel.set_ylim(0, 1.05)
        panel.set_xlabel("frequency (Hz)")
        panel.set_ylabel("coherence (-)")
        panel.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2)
    for panel, there in zip(axes, (areas, coherence), strict=True):
        panel.set_visible(bool(there))


#: A legend between a panel and its title, where it covers no curve.
OUTSIDE: dict[str, Any] = {"loc": "lower left", "bbox_to_anchor": (0, 1)}
TITLE_PAD = 16


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
        panel.set_title("by input and branch", pad=TITLE_PAD)
        panel.legend(**OUTSIDE, ncols=3)
    if over_rate:
        panel = axes[1]
        panel.plot(over_rate["rate"], over_rate["mean"], color=GREEN, label="mean")
        panel.plot(over_rate["rate"], over_rate["rms"], ":", color=BLACK, label="rms")
        panel.set_xlabel(f"rate of the input ({given}/s)")
        panel.set_ylabel(f"residual ({made})")
        panel.set_title("by rate", pad=TITLE_PAD)
        panel.legend(**OUTSIDE, ncols=2)


def plane(axes: Sequence[Axes], curve: dict[str, Any], units: dict[str, str]) -> None:
    """Draw the mean residual over the input and its rate; rows of equal height."""
    (panel,) = axes
    given, made = unit_text(units["input"]), unit_text(units["output"])
    values = np.array([_numbers(row) for row in curve["mean"]])
    most = float(np.nanmax(np.abs(values), initial=0.0)) or 1.0
    rows = np.arange(len(curve["rate"]))
    image = panel.pcolormesh(
        curve["input"],
        rows,
        np.ma.masked_invalid(values),
        cmap="RdBu_r",
        norm=Normalize(-most, most),
    )
    panel.grid(visible=False)
    panel.set_facecolor("0.85")  # cells without samples, which white would call right
    minus = "−"  # noqa: RUF001  (as axes have it, not a hyphen)
    rates = [f"{rate:.3g}".replace("-", minus) for rate in curve["rate"]]
    panel.set_yticks(rows, rates)
    panel.set_xlabel(f"input ({given})")
    panel.set_ylabel(f"rate of the input ({given}/s)")
    panel.set_title("mean residual by the input and its rate")
    bar = panel.figure.colorbar(image, ax=panel, pad=0.02)
    bar.set_label(f"measured {minus} simulated ({made})")
    bar.outline.set_visible(False)


def levels(axes: Any, modes: Sequence[dict[str, Any]], unit: str) -> None:
    """Draw how modes move with the input's level: frequency, damping, gain."""
    marks = []
    looks = ((BLUE, "o", "-"), (VERMILION, "s", "--"))
    for mode, (color, mark, line) in zip(modes, looks, strict=False):
        level = np.array(mode["input"])
        look: dict[str, Any] = {"color": color, "marker": mark, "linestyle": line}
        first = mode["frequency"][0]
        for panel, name, scale, base in (
            (axes[0], "frequency", 100 / first, first),
            (axes[1], "damping", 100.0, 0.0),
            (axes[2], "gain", 1 / mode["gain"][0], 0.0),
        ):
            values = scale * (np.array(mode[name]) - base)
            errors = scale * np.array(mode[f"{name}_error"])
            panel.errorbar(level, values, errors, capsize=2, markersize=4, **look)
        hollow = look | {"linestyle": "none", "markerfacecolor": "none"}
        axes[1].plot(level, 100 * np.array(mode["width"]), markersize=8, **hollow)
        marks.append(Line2D([], [], label=f"{first:.3g} Hz: {mode['kind']}", **look))
    hollow = {"color": GREY, "marker": "o", "markerfacecolor": "none"}
    marks.append(Line2D([], [], linestyle="none", label="width of the peak", **hollow))
    names = ("change of frequency (%)", "damping ratio (%)", "gain over the first (-)")
    for panel, name in zip(axes, names, strict=True):
        panel.set_xlim(0, 1.05 * max(max(mode["input"]) for mode in modes))
        panel.set_xlabel(f"rms of the input ({unit_text(unit)})")
        panel.set_ylabel(name)
    axes[0].axhline(0, color=BLACK, linewidth=0.6)
    axes[1].set_ylim(bottom=0)
    axes[2].set_ylim(bottom=0)
    legend_above(axes[0].figure, marks)


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


def _numbers(values: Sequence[float | None]) -> Any:
    """Turn null into a gap of the line."""
    return np.array([np.nan if each is None else each for each in values])
