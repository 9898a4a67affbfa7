"""What came of the blind contest: shares of cases, and what was answered instead."""

from collections.abc import Mapping, Sequence
from math import ceil
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from hystbench.compare.rows import read_rows
from hystbench.errors import InputError
from hystbench.figures import style

_INTERVAL = ("share", "low", "high", "cases")
#: Ratio of gap to noise (dB) whose cases are drawn.
RATIO_DB = 20.0
#: Families of plants, each with a colour and a marker.
FAMILIES = {
    "gpi": ("GPI plant", style.BLUE, "o"),
    "preisach": ("Preisach plant", style.ORANGE, "s"),
    "jiles-atherton": ("Jiles-Atherton plant", style.GREEN, "^"),
    "duhem": ("Duhem plant", style.PURPLE, "v"),
}
#: The same of machines, in a contest of their own.
MACHINES = {
    "mass-spring": ("mass on a spring", style.BLUE, "o"),
    "free-mass": ("free mass", style.ORANGE, "s"),
    "pendulum": ("pendulum", style.GREEN, "^"),
    "impedance": ("impedance", style.VERMILION, "D"),
    "tank": ("tank", style.PURPLE, "v"),
    "coupled-tanks": ("coupled tanks", style.SKY, "P"),
}
#: How much of an effect's place its families take.
_SPREAD = 0.8
#: Panels side by side.
_ACROSS = 4

_CONFUSION = ("kind", "hidden", "answered", "right", "cases")
#: Answers that are no effect, at the right end.
_LAST = ("no-gap", "unnamed", "parameters", "lost")
_RIGHT = LinearSegmentedColormap.from_list("right", ["white", style.GREEN])
_WRONG = LinearSegmentedColormap.from_list("wrong", ["white", style.VERMILION])


def draw_shares(figures: Mapping[str, str], *, table: Path) -> Figure:
    """Draw a panel a figure, with a mark and an interval for each effect and family.

    Of the cases at 20 dB.

    Parameters
    ----------
    figures : mapping of str to str
        Figures of the table and how they are called.
    table : Path
        ``effect, family, ratio_db, figure, share, low, high, cases``.
    """
    rows = [row for row in _read(table, "figure") if float(row["ratio_db"]) == RATIO_DB]
    if not rows:
        raise InputError(f"{table}: no effect of the blind contest")
    families = _families(rows)
    effects = sorted({row["effect"] for row in rows})
    drawn = Figure(figsize=(style.PAGE, 1.1 + 0.3 * len(effects)))
    panels = drawn.subplots(1, len(figures), sharey=True, squeeze=False)[0]
    for axes, (figure, title) in zip(panels, figures.items(), strict=True):
        for row in rows:
            if row["figure"] == figure and row["share"]:
                _, color, marker = families[row["family"]]
                place = list(families).index(row["family"])
                y = style.in_row(place, len(families), _SPREAD)
                y += effects.index(row["effect"])
                low, share, high = _percent(row)
                axes.plot([low, high], [y, y], color=color, linewidth=0.8)
                axes.plot([share], [y], color=color, marker=marker, linestyle="none")
        axes.set_title(title)
        axes.set_xlim(-3.0, 103.0)
        axes.set_xlabel("share of cases (%)")
        style.name_rows(axes, effects)
    panels[0].set_ylabel("effect")
    style.letter(list(panels))
    style.legend_above(drawn, _handles(rows, families, "none"))
    return drawn


def draw_power(*, table: Path) -> Figure:
    """Draw a panel an effect and one for all, with a line a family of plants.

    Parameters
    ----------
    table : Path
        ``effect, family, ratio_db, share, low, high, cases``.
    """
    rows = _read(table)
    families = _families(rows)
    effects = list(dict.fromkeys(row["effect"] for row in rows))
    lines = ceil(len(effects) / _ACROSS)
    figure = Figure(figsize=(style.PAGE, 0.8 + 1.25 * lines))
    panels = figure.subplots(lines, _ACROSS, sharex=True, sharey=True, squeeze=False)
    for axes, effect in zip(panels.flat, effects, strict=False):
        axes.set_title("all effects" if effect == "all" else effect, fontsize=7)
        for place, (family, (_, color, marker)) in enumerate(families.items()):
            mine = [r for r in rows if (r["effect"], r["family"]) == (effect, family)]
            # side by side where intervals would hide each other
            _curve(axes, mine, color, marker, 0.5 * (place - 1))
    for axes in panels.flat[len(effects) :]:
        axes.set_visible(False)
    for axes in panels[-2, len(effects) % _ACROSS or _ACROSS :] if lines > 1 else []:
        axes.tick_params(labelbottom=True)
    ratios = sorted({float(row["ratio_db"]) for row in rows})
    panels[0, 0].set_xticks(ratios)
    panels[0, 0].set_ylim(-5.0, 105.0)
    figure.supxlabel("gap over noise (dB)", fontsize=8)
    figure.supylabel("cases in which it is named (%)", fontsize=8)
    style.legend_above(figure, _handles(rows, families, "-"))
    return figure


def _curve(
    axes: Axes, rows: list[dict[str, str]], color: str, marker: str, shift: float
) -> None:
    x = [float(row["ratio_db"]) + shift for row in rows]
    for place, row in zip(x, rows, strict=True):
        low, _, high = _percent(row)
        axes.plot([place, place], [low, high], color=color, linewidth=0.6)
    axes.plot(x, [_percent(row)[1] for row in rows], color=color, marker=marker)


def draw_reliability(*, table: Path) -> Figure:
    """Draw the share of named effects that are hidden over the mean stated confidence.

    Parameters
    ----------
    table : Path
        ``from, to, stated, share, low, high, cases``, a row a bin of confidence; none
        where nothing was named.
    """
    rows = read_rows(table, ("from", "to", "stated", *_INTERVAL))
    figure = Figure(figsize=(style.COLUMN, style.COLUMN))
    axes, below = figure.subplots(2, 1, sharex=True, height_ratios=[3, 1])
    axes.plot([0, 100], [0, 100], **style.BEHIND)
    for row in rows:
        x = 100.0 * float(row["stated"])
        low, share, high = _percent(row)
        axes.plot([x, x], [low, high], color=style.BLUE, linewidth=0.8)
        axes.plot([x], [share], color=style.BLUE, marker="o")
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
    line = style.key("as stated", color=style.GREY, linewidth=2.6)
    reached = style.key("reached, 95 % interval", color=style.BLUE, marker="o")
    style.legend_above(figure, [line, reached])
    return figure


def _read(table: Path, *more: str) -> list[dict[str, str]]:
    columns = ("effect", "family", "ratio_db", *more, *_INTERVAL)
    known = {**FAMILIES, **MACHINES}
    rows = [row for row in read_rows(table, columns) if row["family"] in known]
    if not rows:
        raise InputError(f"{table}: no effect of the blind contest")
    return rows


def _families(rows: Sequence[Mapping[str, str]]) -> dict[str, tuple[str, str, str]]:
    """Give the families that a table is of: a contest is of actuators or machines."""
    return MACHINES if any(row["family"] in MACHINES for row in rows) else FAMILIES


def _percent(row: Mapping[str, str]) -> tuple[float, float, float]:
    """Give the low end, the share and the high end in percent."""
    low, share, high = (100.0 * float(row[key]) for key in ("low", "share", "high"))
    return low, share, high


def _handles(
    rows: Sequence[Mapping[str, str]],
    families: Mapping[str, tuple[str, str, str]],
    line: str,
) -> list[Line2D]:
    """Make the legend of the families that are there."""
    there = {row["family"] for row in rows}
    return [
        style.key(label, color=color, marker=marker, linestyle=line)
        for family, (label, color, marker) in families.items()
        if family in there
    ]


def draw_confusion(*, table: Path) -> Figure:
    """Draw the confusion matrix: a row a hidden effect, a column a first answer.

    Colour goes with the root of the share of the row's cases; in each cell stands how
    many there are.

    Parameters
    ----------
    table : Path
        ``kind, hidden, answered, right, cases``.
    """
    rows = read_rows(table, _CONFUSION)
    if not rows:
        raise InputError(f"{table}: no case of the blind contest")
    lines = list(dict.fromkeys(row["hidden"] for row in rows))
    listed = [row["hidden"] for row in rows if row["kind"] == "single"]
    answers = {row["answered"] for row in rows}
    columns = [
        *sorted((answers | set(listed)) - set(_LAST)),
        *(name for name in _LAST if name in answers),
    ]
    counts = np.zeros((len(lines), len(columns)))
    right = np.zeros_like(counts)
    for row in rows:
        place = lines.index(row["hidden"]), columns.index(row["answered"])
        counts[place] += int(row["cases"])
        if row["right"] == "yes":
            right[place] += int(row["cases"])

    figure = Figure(figsize=(style.PAGE, 2.2 + 0.17 * len(lines)))
    axes = figure.subplots()
    axes.grid(visible=False)
    axes.tick_params(length=0)
    # the root: few wrong answers among many are to be seen
    share = np.sqrt(counts / counts.sum(axis=1, keepdims=True))
    mostly = (right >= 0.5 * counts)[:, :, np.newaxis]
    colours = np.where(mostly, _RIGHT(share), _WRONG(share))
    axes.imshow(colours, aspect="auto", interpolation="nearest")
    for (i, j), count in np.ndenumerate(counts):
        if count:
            axes.text(j, i, f"{count:.0f}", ha="center", va="center", fontsize=6)
    axes.set_xticks(range(len(columns)), columns, rotation=90)
    axes.set_yticks(range(len(lines)), lines)
    axes.set_xlabel("first answer")
    axes.set_ylabel("hidden effect")
    patch = {"marker": "s", "markersize": 6, "linestyle": "none"}
    counted = "right (number of cases in each cell)"
    right_key = style.key(counted, color=style.GREEN, **patch)
    wrong_key = style.key("wrong", color=style.VERMILION, **patch)
    style.legend_above(figure, [right_key, wrong_key])
    return figure
