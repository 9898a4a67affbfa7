"""Filters: errors over their order (Figure 7) and time, and how far steps can go."""

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from hystbench.compare.beside import Edge
from hystbench.compare.rows import read_items
from hystbench.compare.runs import read_run
from hystbench.errors import InputError
from hystbench.figures import style
from hystbench.files import read_json
from hystbench.order_errors import OrderError
from hystbench.record import load_record

#: Panels side by side.
_COLUMNS = 3
_EDGES = {
    "at_trace": ("Eq. 19's bound, 1/tr[R]", "D", style.VERMILION),
    "at_power": ("1/max|H|²", "s", style.ORANGE),
    "edge": ("measured edge", "o", style.BLUE),
}


def draw_order(*, table: Path, records: Sequence[Path]) -> Figure:
    """Draw the MSE of each filter over the order, on a logarithmic scale.

    Parameters
    ----------
    table : Path
        The order sweep: model, order, mse, status.
    records : sequence of Path
        The record of the sweep, for its unit.
    """
    points = read_items(table, OrderError)
    record = load_record(*records)
    figure = Figure(figsize=(style.COLUMN, 2.9))
    axes = figure.subplots()
    for model in style.in_order(point.model for point in points):
        mine = [p for p in points if p.model == model]
        finite = [p for p in mine if math.isfinite(p.mse)]
        look = style.look(model)
        axes.plot([p.order for p in finite], [p.mse for p in finite], **look.marked)
        style.mark_above(axes, [p.order for p in mine if p not in finite], look.color)
    axes.set_yscale("log")
    # Room above the data for the marks of what diverged.
    axes.margins(y=0.15)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set(
        xlabel="order $N$ of the filters (-)",
        ylabel=f"MSE ({style.unit_text(record.output.unit)}²)",
    )
    handles = style.handles(
        (point.model for point in points),
        marked=True,
        diverged=not all(math.isfinite(point.mse) for point in points),
    )
    style.legend_above(figure, handles, columns=2)
    return figure


def draw_learning(*, runs: Sequence[Path]) -> Figure:
    """Draw one panel a signal, on a logarithmic scale.

    Only models that learn along the record are drawn: their errors are one-step a
    priori. A diverged run is drawn as far as the scale of the finite ones goes, and
    its end is marked at the upper edge.
    """
    read = zip(map(read_run, runs), map(read_json, runs), strict=True)
    curves = [
        (run, content["smoothed_squared_error"])
        for run, content in read
        if run.error_kind == "one-step a priori"
    ]
    learning = [run for run, _ in curves]
    signals = dict.fromkeys(run.signal for run in learning)
    columns = min(_COLUMNS, len(signals))
    rows = math.ceil(len(signals) / columns)
    figure = Figure(figsize=(style.PAGE, 0.8 + 1.35 * rows))
    grid = figure.subplots(rows, columns, sharey=True, squeeze=False)
    for axes in grid.flat[len(signals) :]:
        axes.remove()
    panels = dict(zip(signals, grid.flat, strict=False))
    for signal, axes in panels.items():
        axes.set_title(style.signal_title(signal))
    for run, curve in curves:
        axes, look = panels[run.signal], style.look(run.model)
        axes.plot(curve["time_s"], curve["value"], **look.line)
        if run.diverged:
            style.mark_above(axes, curve["time_s"][-1:], look.color)
    grid[0, 0].set_yscale("log")
    # The finite runs (all, where every one diverged), with room for marks.
    spanned = [curve for run, curve in curves if not run.diverged] or [
        curve for _, curve in curves
    ]
    values = np.concatenate([curve["value"] for curve in spanned])
    values = values[np.isfinite(values) & (values > 0)]
    grid[0, 0].set_ylim(values.min() / 2, values.max() * 4)
    figure.supxlabel("time (s)", fontsize="medium")
    unit = style.unit_text(learning[0].unit)
    figure.supylabel(f"smoothed squared error ({unit})", fontsize="medium")
    diverged = any(run.diverged for run in learning)
    models = style.handles((run.model for run in learning), diverged=diverged)
    style.legend_above(figure, models)
    return figure


def draw_edges(*, table: Path) -> Figure:
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
        _edges(axes, [edge for edge in edges if edge.model == model], signals)
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
        for label, marker, color in _EDGES.values()
    ]
    handles.append(style.key("µ as configured", color=style.BLACK))
    style.legend_above(figure, handles)
    return figure


def _edges(axes: Axes, edges: list[Edge], signals: list[str]) -> None:
    for edge in edges:
        y = signals.index(edge.signal)
        for name, (_, marker, color) in _EDGES.items():
            value = getattr(edge, name)
            if value is not None:
                (mark,) = axes.plot([value], [y], marker, color=color)
                mark.set_markersize(4)
    axes.axvline(edges[0].mu, color=style.BLACK, linewidth=0.9)
    style.logarithmic(axes, (1.0, 2.0, 5.0))
    style.name_rows(axes, [*map(style.signal_title, signals)], ruled=False)
