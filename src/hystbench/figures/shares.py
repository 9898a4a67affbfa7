"""Shares of cases with their intervals, a line an effect, as several figures draw."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from hystbench.compare.rows import read_rows
from hystbench.errors import InputError
from hystbench.figures import style

COLUMNS = ("effect", "family", "ratio_db", "figure", "share", "low", "high", "cases")
#: Ratio of gap to noise (dB) whose cases are drawn.
RATIO_DB = 20.0
#: Families of plants, each with a colour and a marker.
FAMILIES = {
    "gpi": ("GPI plant", style.BLUE, "o"),
    "preisach": ("Preisach plant", style.ORANGE, "s"),
    "jiles-atherton": ("Jiles-Atherton plant", style.GREEN, "^"),
}
#: How much of an effect's place its families take.
_SPREAD = 0.8


def by_effect(table: Path, figures: Mapping[str, str]) -> Figure:
    """Draw a panel a figure, with a mark and an interval for each effect and family.

    Of the cases at 20 dB.

    Parameters
    ----------
    table : Path
        ``effect, family, ratio_db, figure, share, low, high, cases``.
    figures : mapping of str to str
        Figures of the table and how they are called.
    """
    rows = [
        row
        for row in read_rows(table, COLUMNS)
        if row["family"] in FAMILIES and float(row["ratio_db"]) == RATIO_DB
    ]
    if not rows:
        raise InputError(f"{table}: no effect of the blind contest")
    effects = sorted({row["effect"] for row in rows})
    size = (style.PAGE, 1.1 + 0.3 * len(effects))
    drawn = Figure(figsize=size)
    panels = drawn.subplots(1, len(figures), sharey=True, squeeze=False)[0]
    for axes, (figure, title) in zip(panels, figures.items(), strict=True):
        mine = [row for row in rows if row["figure"] == figure and row["share"]]
        for row in mine:
            mark(axes, row, effects.index(row["effect"]))
        axes.set_title(title)
        axes.set_xlim(-3.0, 103.0)
        axes.set_xlabel("share of cases (%)")
        axes.set_ylim(len(effects) - 0.5, -0.5)
        axes.set_yticks(range(len(effects)), effects)
        axes.tick_params(axis="y", length=0)
        axes.grid(visible=False, axis="y")
        for edge in range(1, len(effects)):
            axes.axhline(edge - 0.5, color=style.GREY, linewidth=0.4)
    panels[0].set_ylabel("effect")
    style.letter(list(panels))
    style.legend_above(drawn, handles({row["family"] for row in rows}))
    return drawn


def mark(axes: Axes, row: Mapping[str, str], place: float) -> None:
    """Draw a share and its interval, in percent, at a place on the vertical axis."""
    order = list(FAMILIES)
    _, color, marker = FAMILIES[row["family"]]
    shift = order.index(row["family"]) - (len(order) - 1) / 2
    y = place + shift * _SPREAD / len(order)
    low, share, high = (100.0 * float(row[key]) for key in ("low", "share", "high"))
    axes.plot([low, high], [y, y], color=color, linewidth=0.8)
    axes.plot([share], [y], color=color, marker=marker, linestyle="none")


def handles(families: Sequence[str] | set[str], line: bool = False) -> list[Line2D]:
    """Make the legend of the families."""
    return [
        Line2D(
            [],
            [],
            color=color,
            marker=marker,
            linestyle="-" if line else "none",
            label=label,
        )
        for family, (label, color, marker) in FAMILIES.items()
        if family in families
    ]
