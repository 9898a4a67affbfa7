"""Errors of every record, a row of marks each.

Marks, not bars: a bar on a logarithmic scale has no honest foot. A diverged run is a
cross right of the scale.
"""

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure

from hystbench.compare.evidence import read_run
from hystbench.figures import style

# How much of a row its marks take.
_SPREAD = 0.7
# Where a cross stands; 1 is the end of the scale.
_BEYOND = 1.03


def draw_by_record(*, runs: Sequence[Path]) -> Figure:
    """Draw the relative error of every model, a row a record and a mark a model."""
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
