"""Pictures of a check: loops of the records, bands and levels, effects by strength."""

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, NullFormatter

from hystbench.figures.style import BLUE, GREY, VERMILION, axis_label
from hystbench.inspection.check import Check
from hystbench.inspection.visible import REVEALED, SmallestSeen

MOST_LOOPS = 8
"""Records whose loops are drawn."""
LOOP_POINTS = 3000
"""Of a loop, at most."""
LOOPS_IN_ROW = 4
"""Loops in a row."""
LEAST_STRENGTH = 1e-4
"""Share of the output below which the axis of strength ends."""


def loops(axes: Sequence[Axes], found: Check) -> None:
    """Draw the output over the input of each record."""
    flat = np.ravel(np.asarray(axes))
    record = found.records[0]
    for ax, item in zip(flat, found.records, strict=False):
        step = max(1, len(item) // LOOP_POINTS)
        colour = BLUE if item.use == "fit" else VERMILION
        ax.plot(item.u[::step], item.y[::step], color=colour, linewidth=0.7)
        ax.set_title(f"{item.name} ({item.use})", fontsize=7)
    for ax in flat[len(found.records) :]:
        ax.set_visible(False)
    columns = min(LOOPS_IN_ROW, len(found.records))
    for k, ax in enumerate(flat[: len(found.records)]):
        if k % columns == 0:
            ax.set_ylabel(axis_label(record.output))
        if k + columns >= min(len(found.records), len(flat)):
            ax.set_xlabel(axis_label(record.input))


def bands(axes: Sequence[Axes], found: Check) -> None:
    """Draw each record's band, over the swing of its input."""
    (ax,) = axes
    for use, colour in (("fit", BLUE), ("hold-out", VERMILION)):
        inputs = [item.input for item in found.facts if item.use == use]
        for k, given in enumerate(inputs):
            ax.plot(
                [given.low_hz, given.high_hz],
                [given.span, given.span],
                color=colour,
                marker="|",
                markersize=7,
                linewidth=2,
                alpha=0.8,
                label=None if k else use,
            )
    ax.set_xscale("log")
    ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    ax.xaxis.set_minor_formatter(NullFormatter())
    ax.set_ylim(bottom=0)
    ax.set_xlabel("frequency (Hz)")
    name = found.records[0].input
    ax.set_ylabel(axis_label(type(name)(f"{name.name}, peak to peak", name.unit)))
    _legend(ax)


def strengths(axes: Sequence[Axes], effects: Sequence[SmallestSeen]) -> None:
    """Draw from which strength on each effect is seen, and told from every other."""
    (ax,) = axes
    shown = [item for item in effects if math.isfinite(item.seen_from)]
    places = np.arange(len(shown))
    seen = np.array([max(item.seen_from, LEAST_STRENGTH) for item in shown])
    told = np.array([item.told_from for item in shown])
    top = 3.0
    for place, low, high in zip(places, seen, told, strict=True):
        ax.plot([low, min(high, top)], [place, place], color=GREY, linewidth=1)
    ax.plot(seen, places, "o", color=BLUE, label="seen from", markersize=5)
    inside = told <= top
    ax.plot(
        told[inside],
        places[inside],
        "D",
        color=VERMILION,
        markersize=4,
        label="told from all others from",
        fillstyle="none",
    )
    if (~inside).any():
        ax.plot(
            np.full(np.count_nonzero(~inside), top),
            places[~inside],
            ">",
            color=VERMILION,
            markersize=5,
            label="never told from one",
        )
    ax.axvline(REVEALED, color=GREY, linestyle="--", linewidth=0.8)
    ax.set_xscale("log")
    ax.set_xlim(min(float(seen.min(initial=1e-2)), 1e-2) / 1.5, top * 1.25)
    ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:g}"))
    ax.xaxis.set_minor_formatter(NullFormatter())
    ax.set_xlabel("what the effect adds, rms (% of the output)")
    ax.set_yticks(places, [item.effect for item in shown])
    ax.invert_yaxis()
    ax.grid(axis="x", alpha=0.3)
    _legend(ax)


def _legend(ax: Axes) -> None:
    """Put the legend above the axes, in one row."""
    ax.legend(loc="lower left", bbox_to_anchor=(0, 1), ncols=3, frameon=False)
