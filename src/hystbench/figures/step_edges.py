"""How far each step size can go, beside Eq. 19's bound."""

from __future__ import annotations

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullFormatter

from hystbench.compare.edges import Edge, read_edges
from hystbench.errors import InputError
from hystbench.figures import style

_MARKS = {
    "at_trace": ("Eq. 19's bound, 1/tr[R]", "D", style.VERMILION),
    "at_power": ("1/max|H|²", "s", style.ORANGE),
    "edge": ("measured edge", "o", style.BLUE),
}


def draw(*, table: Path) -> Figure:
    """Draw a panel a filter, a row a signal: the edge, both bounds and mu itself.

    Parameters
    ----------
    table : Path
        Edges of the step sizes.
    """
    edges = read_edges(table)
    if not edges:
        raise InputError(f"{table}: no edge")
    signals = list(dict.fromkeys(edge.signal for edge in edges))
    models = style.in_order(edge.model for edge in edges)
    rows = (len(models) + 1) // 2
    figure = Figure(figsize=(style.PAGE, 0.9 + rows * (0.45 + 0.17 * len(signals))))
    columns = min(2, len(models))
    panels = figure.subplots(rows, columns, sharey=True, squeeze=False)
    for axes, model in zip(panels.flat, models, strict=False):
        _panel(axes, [edge for edge in edges if edge.model == model], signals)
        name = style.look(model).label
        axes.set_title(name, loc="left")
        axes.set_xlabel(
            "step size µ of first order" if model == "volterra" else "step size µ"
        )
    for axes in list(panels.flat)[len(models) :]:
        axes.remove()
    for line in panels:
        line[0].set_ylabel("signal")
    style.letter(list(panels.flat)[: len(models)])
    handles = [
        Line2D([], [], color=color, marker=marker, linestyle="none", label=label)
        for label, marker, color in _MARKS.values()
    ]
    handles.append(Line2D([], [], color=style.BLACK, label="µ as configured"))
    style.legend_above(figure, handles)
    return figure


def _panel(axes: Axes, edges: list[Edge], signals: list[str]) -> None:
    for edge in edges:
        y = signals.index(edge.signal)
        for name, (_, marker, color) in _MARKS.items():
            value = getattr(edge, name)
            if value is not None:
                axes.plot(
                    [value],
                    [y],
                    marker=marker,
                    color=color,
                    linestyle="none",
                    markersize=4,
                )
    axes.axvline(edges[0].mu, color=style.BLACK, linewidth=0.9)
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_yticks(range(len(signals)), [*map(style.signal_title, signals)])
    axes.set_ylim(len(signals) - 0.5, -0.5)
    axes.tick_params(axis="y", length=0)
    axes.grid(visible=False, axis="y")
