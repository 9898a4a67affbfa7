"""Relative error of every model on every record."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from hystbench.compare.evidence import read_run
from hystbench.figures import style

# How much of a record's row its models take.
_SPREAD = 0.7


def draw(*, runs: Sequence[Path]) -> Figure:
    """Draw a row a record and a mark a model, on a logarithmic scale.

    Marks, not bars: a bar on a logarithmic scale has no honest foot. A diverged run
    is a cross right of the scale.
    """
    read = [read_run(path) for path in runs]
    signals = list(dict.fromkeys(run.signal for run in read))
    models = style.in_order(run.model for run in read)
    figure = Figure(figsize=(5.0, 1.2 + 0.4 * len(signals)))
    axes = figure.subplots()
    for run in read:
        look = style.look(run.model)
        place = models.index(run.model) - (len(models) - 1) / 2
        y = signals.index(run.signal) + place * _SPREAD / len(models)
        if run.re is None:
            across = axes.get_yaxis_transform()
            mark = {**style.DIVERGED, "transform": across, "clip_on": False}
            axes.plot([1.03], [y], color=look.color, **mark)
        else:
            mark = {"marker": look.marker, "linestyle": "none"}
            axes.plot([run.re], [y], color=look.color, **mark)
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_formatter("")
    axes.set_yticks(range(len(signals)), [*map(style.signal_title, signals)])
    axes.set_ylim(len(signals) - 0.5, -0.5)
    axes.tick_params(axis="y", length=0)
    axes.grid(visible=False, axis="y")
    for edge in range(1, len(signals)):
        axes.axhline(edge - 0.5, color=style.GREY, linewidth=0.4)
    axes.set(xlabel="relative error RE (-)", ylabel=f"record ({read[0].origin})")
    handles = style.handles(models, marked=True, diverged=any(r.diverged for r in read))
    for handle in handles:
        handle.set_linestyle("none")
    style.legend_above(figure, handles, columns=3)
    return figure
