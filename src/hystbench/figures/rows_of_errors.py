"""Errors in rows of marks: of every record, and of the contest of step sizes.

Marks, not bars: a bar on a logarithmic scale has no honest foot. A diverged run is a
cross right of the scale.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from hystbench.compare.evidence import read_run
from hystbench.figures import style
from hystbench.figures.data import read_table

_COLUMNS = ("twin", "family", "algorithm", "protocol", "signal", "model", "mse")
# How much of a row its marks take.
_SPREAD, _SPREAD_BY_RECORD = 0.6, 0.7


def draw_by_record(*, runs: Sequence[Path]) -> Figure:
    """Draw the relative error of every model, a row a record and a mark a model."""
    read = [read_run(path) for path in runs]
    signals = list(dict.fromkeys(run.signal for run in read))
    models = style.in_order(run.model for run in read)
    figure = Figure(figsize=(5.0, 1.2 + 0.4 * len(signals)))
    axes = figure.subplots()
    for run in read:
        row = style.in_row(models.index(run.model), len(models), _SPREAD_BY_RECORD)
        y = signals.index(run.signal) + row
        _mark(axes, run.re, y, run.model, beyond=1.03)
    style.logarithmic(axes, (1.0, 2.0, 5.0))
    style.name_rows(axes, [*map(style.signal_title, signals)])
    axes.set(xlabel="relative error RE (-)", ylabel=f"record ({read[0].origin})")
    diverged = any(run.diverged for run in read)
    style.legend_above(figure, _handles(models, diverged), columns=3)
    return figure


def draw_contest(*, table: Path) -> Figure:
    """Draw a row of panels a twin, a panel an algorithm, a mark a filter and signal.

    A filled mark is the error with one step size that was chosen on other signals, a
    hollow one that with the best step size for the signal.

    Parameters
    ----------
    table : Path
        Entries of the contest.
    """
    rows = read_table(table, _COLUMNS, "entry of a contest")
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
        line[0].set_ylabel("signal")
        for axes, algorithm in zip(line, algorithms, strict=True):
            for row in rows:
                if (row["twin"], row["algorithm"]) == (twin, algorithm):
                    place = models.index(row["model"])
                    y = style.in_row(place, len(models), _SPREAD)
                    y += signals.index(row["signal"])
                    error = float(row["mse"]) if row["mse"] else None
                    filled = row["protocol"] == "held-out"
                    _mark(axes, error, y, row["model"], beyond=1.02, filled=filled)
            style.logarithmic(axes)
            style.name_rows(axes, [*map(style.signal_title, signals)])
            axes.set_title(f"{algorithm}, twin {twin} ({family})", loc="left")
    for axes in panels[-1]:
        axes.set_xlabel("MSE (µm²)")
    style.letter(list(panels.flat))
    kinds = {"chosen on other signals": style.BLACK, "best for each": "white"}
    handles = [
        *_handles(models, diverged=any(not row["mse"] for row in rows)),
        *(
            style.key(
                label,
                color=style.BLACK,
                marker="o",
                linestyle="none",
                markerfacecolor=face,
            )
            for label, face in kinds.items()
        ),
    ]
    style.legend_above(figure, handles, columns=4)
    return figure


def _mark(
    axes: Axes,
    error: float | None,
    y: float,
    model: str,
    *,
    beyond: float,
    filled: bool = True,
) -> None:
    """Mark an error, or right of the scale (1 is its end) that there is none."""
    look = style.look(model)
    if error is None:
        across = axes.get_yaxis_transform()
        mark = {**style.DIVERGED, "transform": across, "clip_on": False}
        axes.plot([beyond], [y], color=look.color, **mark)
        return
    face = look.color if filled else "none"
    mark = {"marker": look.marker, "linestyle": "none", "markerfacecolor": face}
    axes.plot([error], [y], color=look.color, **mark)


def _handles(models: Sequence[str], diverged: bool) -> list[Line2D]:
    handles = style.handles(models, marked=True, diverged=diverged)
    for handle in handles:
        handle.set_linestyle("none")
    return handles
