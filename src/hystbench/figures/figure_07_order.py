"""Figure 7: error of the filters against their order."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from hystbench.compare.evidence import read_order_sweep
from hystbench.errors import InputError
from hystbench.figures import style
from hystbench.record import load_record


def draw(*, table: Path, records: Sequence[Path]) -> Figure:
    """Draw the MSE of each filter over the order, on a logarithmic scale.

    Parameters
    ----------
    table : Path
        The order sweep: model, order, mse, status.
    records : sequence of Path
        The record of the sweep, for its unit.
    """
    points = read_order_sweep(table)
    if len(records) != 1:
        raise InputError(f"{len(records)} records; expected the one of the sweep")
    record = load_record(records[0])

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
