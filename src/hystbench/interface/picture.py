"""Figures of records and gaps, as notebooks show them: labelled, with units."""

import io
from collections.abc import Callable, Sequence
from typing import Any

from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from hystbench.figures.style import (
    BLUE,
    GREY,
    PAGE,
    VERMILION,
    axis_label,
    in_style,
    plain_ticks,
    thin,
    unit_text,
)
from hystbench.gap.report.pictures import STRETCHES, TICKS, left_over_time
from hystbench.gap.report.read import HoldOut
from hystbench.record import FloatArray, Record

RESOLUTION = 130
"""Dots an inch in a notebook."""
MEASURED: dict[str, Any] = {"color": GREY, "linewidth": 2.2, "label": "measured"}
BEFORE: dict[str, Any] = {"color": VERMILION, "linestyle": "--", "label": "before"}
AFTER: dict[str, Any] = {"color": BLUE, "label": "after"}

Outputs = tuple[FloatArray, FloatArray]
"""Output of a record before and after, shape (n,) each."""


class Picture(Figure):
    """A figure that a notebook shows by itself, once, whatever its backend is.

    It belongs to no window; ``savefig`` writes it to a file.
    """

    def _repr_png_(self) -> bytes:
        buffer = io.BytesIO()
        with in_style():
            self.savefig(buffer, format="png", dpi=RESOLUTION, bbox_inches="tight")
        return buffer.getvalue()


def drawn(
    paint: Callable[[Any], None], rows: int, columns: int, height: float
) -> Picture:
    """Draw panels in hystbench's style.

    Parameters
    ----------
    paint : callable
        Given the axes, shape (rows, columns).
    rows, columns : int
    height : float
        Of a row, in inches.

    Returns
    -------
    Picture
    """
    with in_style():
        figure = Picture(figsize=(PAGE, height * rows), layout="constrained")
        paint(figure.subplots(rows, columns, squeeze=False))
        plain_ticks(figure)
        figure.draw_without_rendering()
    return figure


def records(axes: Any, shown: Sequence[Record]) -> None:
    """Draw input, output and loop of each record, a row each."""
    for row, record in zip(axes, shown, strict=True):
        given, got, loop = row
        given.plot(*thin(record.time, record.u, STRETCHES), color=BLUE)
        got.plot(*thin(record.time, record.y, STRETCHES), color=BLUE)
        loop.plot(record.u, record.y, color=BLUE, linewidth=0.8)
        given.set_title(f"{record.name} ({record.use})")
        for panel in (given, got):
            panel.set_xlabel("time (s)")
        given.set_ylabel(axis_label(record.input))
        got.set_ylabel(axis_label(record.output))
        loop.set_xlabel(axis_label(record.input))
        loop.set_ylabel(axis_label(record.output))
        _few_ticks(row)


def gap(
    axes: Any, held_out: Sequence[Record], outputs: Sequence[Outputs], floor: float
) -> None:
    """Draw each hold-out record: its loop and its residual, before and after."""
    for row, record, (before, after) in zip(axes, held_out, outputs, strict=True):
        loop, left = row
        for values, line in ((record.y, MEASURED), (before, BEFORE), (after, AFTER)):
            loop.plot(record.u, values, **line)
        loop.set_title(record.name)
        loop.set_xlabel(axis_label(record.input))
        loop.set_ylabel(axis_label(record.output))
        shown = (record.name, floor, record.output.unit, record.time, record.y)
        left_over_time(left, HoldOut(*shown, before, after), slice(None))
        left.set_ylabel(f"residual ({unit_text(record.output.unit)})")
        _few_ticks(row)
    lines = axes[0][0].get_legend_handles_labels()[0]
    axes[0][0].figure.legend(handles=lines, loc="outside upper center", ncols=3)


def _few_ticks(panels: Any) -> None:
    for panel in panels:
        panel.xaxis.set_major_locator(MaxNLocator(TICKS))
        panel.yaxis.set_major_locator(MaxNLocator(TICKS))
