"""Errors of every signal and model: over the published ones, or a row of marks each."""

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from hystbench.compare.cells import NOT_RUN, ComparedCell
from hystbench.compare.rows import read_items
from hystbench.compare.runs import read_run
from hystbench.figures import style

# Blue and red stay apart for all kinds of colour blindness, and white is agreement.
_MAP = "RdBu_r"
# Behind the name of a signal that the twin was not fitted to.
_HELD_OUT = "\N{BLACK DIAMOND}"
# A factor of ten; what is beyond has the colour of the end, and its number.
_LIMIT = 1.0
# How much of a row its marks take.
_SPREAD = 0.7
# Where a cross stands; 1 is the end of the scale.
_BEYOND = 1.03


def draw_heat_map(*, table: Path) -> Figure:
    """Draw log10(ours / published) of the MSE, a number in each cell.

    Parameters
    ----------
    table : Path
        The compared cells, one row a signal, model and metric.
    """
    cells = [cell for cell in read_items(table, ComparedCell) if cell.metric == "mse"]
    signals = list(dict.fromkeys(cell.signal for cell in cells))
    models = style.in_order(cell.model for cell in cells)
    figure = Figure(figsize=(5.0, 1.5 + 0.24 * len(signals)))
    axes = figure.subplots()
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)
    axes.tick_params(length=0)

    values = np.full((len(signals), len(models)), np.nan)
    for cell in cells:
        if cell.log10_ratio is not None:
            place = signals.index(cell.signal), models.index(cell.model)
            values[place] = cell.log10_ratio
    image = axes.pcolormesh(
        values, cmap=_MAP, norm=Normalize(-_LIMIT, _LIMIT), edgecolor="white"
    )
    axes.invert_yaxis()
    for cell in cells:
        x, y = models.index(cell.model), signals.index(cell.signal)
        value = values[y, x]
        told = NOT_RUN if cell.status == NOT_RUN else "diverged"
        if math.isfinite(value):
            told = f"{value:+.2f}".replace("-", "\N{MINUS SIGN}")
        axes.text(
            x + 0.5,
            y + 0.5,
            told,
            horizontalalignment="center",
            verticalalignment="center_baseline",
            color="white" if abs(value) > 0.6 * _LIMIT else style.BLACK,
            fontsize="small",
        )
        if cell.published_consistent != "yes":
            axes.add_patch(_frame(x, y, cell.published_consistent))
    labels = [style.look(model).label.replace(" ", "\n") for model in models]
    axes.set_xticks(np.arange(len(models)) + 0.5, labels)
    unseen = {cell.signal for cell in cells if cell.half == "held-out"}
    titles = [
        style.signal_title(s) + (f" {_HELD_OUT}" if s in unseen else "")
        for s in signals
    ]
    axes.set_yticks(np.arange(len(signals)) + 0.5, titles)
    axes.xaxis.tick_top()
    axes.set(xlabel="model", ylabel="signal")
    axes.xaxis.set_label_position("top")
    bar = figure.colorbar(image, ax=axes, extend="both", pad=0.02, aspect=30)
    bar.set_label(r"$\log_{10}$(MSE, ours / published) (-)")
    bar.outline.set_visible(False)
    figure.legend(
        handles=[
            Patch(fill=False, label="published pair of MSE and RE inconsistent"),
            Patch(fill=False, label="perhaps inconsistent", linestyle=":"),
            style.key(
                "held out of the calibration",
                color=style.BLACK,
                linestyle="none",
                marker=f"${_HELD_OUT}$",
            ),
        ],
        loc="outside lower center",
        ncols=2,
    )
    return figure


def _frame(x: int, y: int, consistent: str) -> Rectangle:
    """Frame a cell whose published pair cannot be true, or may not be."""
    return Rectangle(
        (x + 0.04, y + 0.08),
        0.92,
        0.84,
        fill=False,
        edgecolor=style.BLACK,
        linewidth=1.0,
        linestyle="-" if consistent == "no" else ":",
    )


def draw_by_record(*, runs: Sequence[Path]) -> Figure:
    """Draw the relative error of every model, a row a record and a mark a model.

    Marks, not bars: a bar on a logarithmic scale has no honest foot. A diverged run is
    a cross right of the scale.
    """
    read = [read_run(path) for path in runs]
    signals = list(dict.fromkeys(run.signal for run in read))
    models = style.in_order(run.model for run in read)
    figure = Figure(figsize=(5.0, 1.2 + 0.4 * len(signals)))
    axes = figure.subplots()
    for run in read:
        row = style.in_row(models.index(run.model), len(models), _SPREAD)
        y, look = signals.index(run.signal) + row, style.look(run.model)
        if run.re is None:
            across = axes.get_yaxis_transform()
            mark = {**style.DIVERGED, "transform": across, "clip_on": False}
            axes.plot([_BEYOND], [y], color=look.color, **mark)
        else:
            mark = {"marker": look.marker, "linestyle": "none"}
            axes.plot([run.re], [y], color=look.color, **mark)
    style.logarithmic(axes, (1.0, 2.0, 5.0))
    style.name_rows(axes, [*map(style.signal_title, signals)])
    axes.set(xlabel="relative error RE (-)", ylabel=f"record ({read[0].origin})")
    diverged = any(run.diverged for run in read)
    handles = style.handles(models, marked=True, diverged=diverged)
    for handle in handles:
        handle.set_linestyle("none")
    style.legend_above(figure, handles, columns=3)
    return figure
