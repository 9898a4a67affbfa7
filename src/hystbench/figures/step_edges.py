"""How far each step size can go, beside Eq. 19's bound."""

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hystbench.compare.beside import Edge
from hystbench.compare.rows import read_items
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
    edges = read_items(table, Edge)
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
        axes.set_title(style.look(model).label, loc="left")
        axes.set_xlabel(
            "step size µ of first order (1/A²)"
            if model == "volterra"
            else "step size µ (1/|H|²)"
        )
    for axes in list(panels.flat)[len(models) :]:
        axes.remove()
    for line in panels:
        line[0].set_ylabel("signal")
    style.letter(list(panels.flat)[: len(models)])
    handles = [
        style.key(label, color=color, marker=marker, linestyle="none")
        for label, marker, color in _MARKS.values()
    ]
    handles.append(style.key("µ as configured", color=style.BLACK))
    style.legend_above(figure, handles)
    return figure


def _panel(axes: Axes, edges: list[Edge], signals: list[str]) -> None:
    for edge in edges:
        y = signals.index(edge.signal)
        for name, (_, marker, color) in _MARKS.items():
            value = getattr(edge, name)
            if value is not None:
                (mark,) = axes.plot([value], [y], marker, color=color)
                mark.set_markersize(4)
    axes.axvline(edges[0].mu, color=style.BLACK, linewidth=0.9)
    style.logarithmic(axes, (1.0, 2.0, 5.0))
    style.name_rows(axes, [*map(style.signal_title, signals)], ruled=False)
