"""Each filter with its own best step size, LMS beside normalized LMS."""

from __future__ import annotations

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator

from hystbench.compare.rows import read_rows
from hystbench.errors import InputError
from hystbench.figures import style

_COLUMNS = ("twin", "family", "algorithm", "protocol", "signal", "model", "mse")
# How much of a signal's place its filters take.
_SPREAD = 0.6


def draw(*, table: Path) -> Figure:
    """Draw a row of panels a twin, a panel an algorithm, a mark a filter and signal.

    A filled mark is the error with one step size that was chosen on other signals, a
    hollow one that with the best step size for the signal.

    Parameters
    ----------
    table : Path
        Entries of the contest.
    """
    rows = read_rows(table, _COLUMNS)
    if not rows:
        raise InputError(f"{table}: no entry of a contest")
    signals = list(dict.fromkeys(row["signal"] for row in rows))
    models = style.in_order(row["model"] for row in rows)
    twins = list(dict.fromkeys((row["twin"], row["family"]) for row in rows))
    algorithms = list(dict.fromkeys(row["algorithm"] for row in rows))
    size = (style.PAGE, 1.1 + 0.2 * len(signals) * len(twins) + 0.5 * len(twins))
    figure = Figure(figsize=size)
    panels = figure.subplots(
        len(twins), len(algorithms), sharex=True, sharey=True, squeeze=False
    )
    for line, (twin, family) in zip(panels, twins, strict=True):
        for axes, algorithm in zip(line, algorithms, strict=True):
            mine = [r for r in rows if (r["twin"], r["algorithm"]) == (twin, algorithm)]
            _panel(axes, mine, signals, models)
            axes.set_title(f"{algorithm}, twin {twin} ({family})", loc="left")
    for axes in panels[-1]:
        axes.set_xlabel("MSE (µm²)")
    for line in panels:
        line[0].set_ylabel("signal")
    style.letter(list(panels.flat))
    diverged = any(not row["mse"] for row in rows)
    handles = style.handles(models, marked=True, diverged=diverged)
    for handle in handles:
        handle.set_linestyle("none")
    handles += [_kind("chosen on other signals", True), _kind("best for each", False)]
    style.legend_above(figure, handles, columns=4)
    return figure


def _panel(
    axes: Axes, rows: list[dict[str, str]], signals: list[str], models: list[str]
) -> None:
    for row in rows:
        look = style.look(row["model"])
        place = models.index(row["model"]) - (len(models) - 1) / 2
        y = signals.index(row["signal"]) + place * _SPREAD / len(models)
        if not row["mse"]:
            across = axes.get_yaxis_transform()
            mark = {**style.DIVERGED, "transform": across, "clip_on": False}
            axes.plot([1.02], [y], color=look.color, **mark)
            continue
        filled = row["protocol"] == "held-out"
        axes.plot(
            [float(row["mse"])],
            [y],
            color=look.color,
            marker=look.marker,
            linestyle="none",
            markerfacecolor=look.color if filled else "none",
        )
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(LogLocator())
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_formatter("")
    axes.set_yticks(range(len(signals)), [*map(style.signal_title, signals)])
    axes.set_ylim(len(signals) - 0.5, -0.5)
    axes.tick_params(axis="y", length=0)
    axes.grid(visible=False, axis="y")
    for edge in range(1, len(signals)):
        axes.axhline(edge - 0.5, color=style.GREY, linewidth=0.4)


def _kind(label: str, filled: bool) -> Line2D:
    return Line2D(
        [],
        [],
        color=style.BLACK,
        marker="o",
        linestyle="none",
        markerfacecolor=style.BLACK if filled else "white",
        label=label,
    )
