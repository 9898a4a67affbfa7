"""The page of a check: tables and pictures, HTML in one file."""

import math
from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, NullFormatter

from hystbench.figures.style import (
    BLUE,
    COLUMN,
    GREY,
    PAGE,
    VERMILION,
    axis_label,
    unit_text,
)
from hystbench.gap.fitting.parameter_units import unit_written
from hystbench.gap.report.pictures import EmbeddedPicture, draw
from hystbench.inspection.check import Check
from hystbench.inspection.facts import Facts
from hystbench.inspection.screen import (
    FLOORS,
    KINDS,
    band,
    capital,
    jitter_text,
    percent,
    quantity,
    words_of,
)
from hystbench.inspection.visible import REVEALED, SmallestSeen, could_do
from hystbench.report.layout import page_environment
from hystbench.report.markup import one_micro
from hystbench.report.table import PageTable, number, table_in

MOST_LOOPS = 8
"""Records whose loops are drawn."""
LOOP_POINTS = 3000
"""Most points of a loop."""
LOOPS_IN_ROW = 4
"""Loops in a row."""
LEAST_STRENGTH = 1e-4
"""Share of the output below which the axis of strength ends."""
RIVALS_TOLD = 2
"""Rivals that are named."""


def page(found: Check) -> str:
    """Make the page, HTML in one file."""
    template = page_environment("hystbench.inspection").get_template("page.html.j2")
    record = found.records[0]
    unit = unit_text(record.output.unit)
    words, judged = words_of(found), len(found.judged)
    made = template.render(
        name=found.dataset.name,
        headline=" ".join(words("headline")),
        channels=f"{record.input.name} ({unit_text(record.input.unit)}) to "
        f"{record.output.name} ({unit})",
        noise=f"{quantity(found.floor.rms, record.output.unit)} rms, "
        f"{FLOORS[found.floor.method]}",
        leaves=capital(" ".join(words("leaves"))),
        called=found.base.called,
        could=could_do(True, bool(found.base.model.free)),
        findings=found.findings,
        kinds=KINDS,
        records=_table(found, "records", found.facts),
        pictures=_pictures(found),
        misfit=" ".join(words("misfit")),
        chart=_chart(found),
        revealed=_table(found, "revealed", found.revealed, every=judged),
        hidden=_table(found, "hidden", found.hidden, every=judged),
        unjudged=_table(found, "unjudged", found.unjudged, every=len(found.effects)),
    )
    return one_micro(made)


def _table(found: Check, name: str, items: Sequence[Any], **known: Any) -> PageTable:
    record = found.records[0]
    given = {
        "band": band,
        "called": found.base.called,
        "input": unit_text(record.input.unit),
        "jitter": _jitter,
        "mistaken": _mistaken,
        "number": number,
        "output": unit_text(record.output.unit),
        "percent": percent,
        "shown": len(items),
        "strength": partial(_strength, found),
        **known,
    }
    return table_in(__package__, name, items, given)


def _jitter(item: Facts) -> str:
    if item.jitter is None:
        return "no clock"
    return jitter_text(item.jitter).removesuffix(" %")


def _pictures(found: Check) -> list[EmbeddedPicture]:
    count = min(len(found.records), MOST_LOOPS)
    columns = min(count, LOOPS_IN_ROW)
    rows = math.ceil(count / columns)
    more = len(found.records) - count
    rest = f"; {more} more are not drawn" if more else ""
    return [
        draw(
            loops,
            found,
            words=f"Output over input of each record{rest}",
            height=0.4 + 1.6 * rows,
            width=PAGE if columns > 1 else COLUMN,
            panels=(rows, columns),
        ),
        draw(
            bands,
            found,
            words="Band and swing of each record's input: between and beyond them "
            "nothing is known of the device",
            height=2.4,
        ),
    ]


def _chart(found: Check) -> EmbeddedPicture | None:
    shown = [item for item in found.effects if math.isfinite(item.seen_from)]
    if not shown:
        return None
    return draw(
        strengths,
        found.effects,
        words="How strong each effect must be to be seen, and to be told from every "
        f"other effect; beyond the dashed line, {100 * REVEALED:g} % of the output, it "
        "counts as not revealed",
        height=0.8 + 0.2 * len(shown),
    )


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


def _strength(found: Check, item: SmallestSeen) -> str:
    """Write the number at which an effect is seen first, with its unit."""
    record = found.records[0]
    if math.isnan(item.value):
        return ""
    unit = unit_written(item.unit, record.input.unit, record.output.unit)
    name = item.number.replace("_", " ").removesuffix(" s").removesuffix(" hz")
    return f"{name} {quantity(item.value, unit)}"


def _mistaken(item: SmallestSeen) -> str:
    """Say what an effect may be mistaken for until it is how large."""
    near = item.rivals[:RIVALS_TOLD]
    if not near:
        return ""
    told = [
        f"{name} (never told)" if share > 1 else f"{name} (up to {percent(share)})"
        for name, share in near
    ]
    more = len(item.rivals) - len(near)
    return ", ".join(told) + (f" and {more} more" if more else "")
