"""Power curves: how often an effect is named, by its ratio to the noise."""

from __future__ import annotations

from math import ceil
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hystbench.compare.rows import read_rows
from hystbench.errors import InputError
from hystbench.figures import style
from hystbench.figures.shares import FAMILIES, handles

_COLUMNS = ("effect", "family", "ratio_db", "share", "low", "high", "cases")
_ACROSS = 4


def draw(*, table: Path) -> Figure:
    """Draw a panel an effect and one for all, with a line a family of plants.

    Parameters
    ----------
    table : Path
        ``effect, family, ratio_db, share, low, high, cases``.
    """
    rows = [row for row in read_rows(table, _COLUMNS) if row["family"] in FAMILIES]
    if not rows:
        raise InputError(f"{table}: no effect of the blind contest")
    effects = list(dict.fromkeys(row["effect"] for row in rows))
    lines = ceil(len(effects) / _ACROSS)
    figure = Figure(figsize=(style.PAGE, 0.8 + 1.25 * lines))
    panels = figure.subplots(lines, _ACROSS, sharex=True, sharey=True, squeeze=False)
    for axes, effect in zip(panels.flat, effects, strict=False):
        axes.set_title("all effects" if effect == "all" else effect, fontsize=7)
        for family in FAMILIES:
            mine = [r for r in rows if (r["effect"], r["family"]) == (effect, family)]
            _curve(axes, mine, family)
    for axes in panels.flat[len(effects) :]:
        axes.set_visible(False)
    for axes in panels[-2, len(effects) % _ACROSS or _ACROSS :] if lines > 1 else []:
        axes.tick_params(labelbottom=True)
    ratios = sorted({float(row["ratio_db"]) for row in rows})
    panels[0, 0].set_xticks(ratios)
    panels[0, 0].set_ylim(-5.0, 105.0)
    figure.supxlabel("gap over noise (dB)", fontsize=8)
    figure.supylabel("cases in which it is named (%)", fontsize=8)
    style.legend_above(figure, handles({row["family"] for row in rows}, line=True))
    return figure


def _curve(axes: Axes, rows: list[dict[str, str]], family: str) -> None:
    _, color, marker = FAMILIES[family]
    # side by side where intervals would hide each other
    shift = 0.5 * (list(FAMILIES).index(family) - 1)
    x = [float(row["ratio_db"]) + shift for row in rows]
    for place, row in zip(x, rows, strict=True):
        ends = [100.0 * float(row["low"]), 100.0 * float(row["high"])]
        axes.plot([place, place], ends, color=color, linewidth=0.6)
    share = [100.0 * float(row["share"]) for row in rows]
    axes.plot(x, share, color=color, marker=marker)
