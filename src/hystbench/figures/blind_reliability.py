"""Reliability diagram: stated confidence against what happened."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from hystbench.compare.rows import read_rows
from hystbench.figures import style

_COLUMNS = ("from", "to", "stated", "share", "low", "high", "cases")


def draw(*, table: Path) -> Figure:
    """Draw the share of named effects that are hidden over the mean stated confidence.

    Parameters
    ----------
    table : Path
        ``from, to, stated, share, low, high, cases``, a row a bin of confidence; none
        where nothing was named.
    """
    rows = read_rows(table, _COLUMNS)
    figure = Figure(figsize=(style.COLUMN, style.COLUMN))
    axes, below = figure.subplots(2, 1, sharex=True, height_ratios=[3, 1])
    axes.plot([0, 100], [0, 100], **style.BEHIND)
    for row in rows:
        x = 100.0 * float(row["stated"])
        ends = [100.0 * float(row["low"]), 100.0 * float(row["high"])]
        axes.plot([x, x], ends, color=style.BLUE, linewidth=0.8)
        axes.plot([x], [100.0 * float(row["share"])], color=style.BLUE, marker="o")
        low, high = 100.0 * float(row["from"]), 100.0 * float(row["to"])
        below.bar(
            low, int(row["cases"]), high - low, align="edge", color=style.BLUE, lw=0
        )
    axes.set_ylabel("hidden indeed (%)")
    below.set_ylabel("effects (-)")
    below.set_xlabel("stated confidence (%)")
    axes.set_xlim(-2.0, 102.0)
    axes.set_ylim(-2.0, 102.0)
    style.letter([axes, below])
    line = Line2D([], [], color=style.GREY, linewidth=2.6, label="as stated")
    reached = Line2D(
        [], [], color=style.BLUE, marker="o", label="reached, 95 % interval"
    )
    style.legend_above(figure, [line, reached])
    return figure
