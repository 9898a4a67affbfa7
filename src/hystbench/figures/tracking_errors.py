"""Open-loop tracking on the twin, with and without the inverse."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hystbench.figures import style
from hystbench.figures.data import read_table
from hystbench.inverse.told import GOAL
from hystbench.inverse.tracking import (
    CODE,
    DRIVES,
    FIELD,
    LINEAR,
    OWN,
    WITH,
    WITHOUT,
)

LOOKS = {
    LINEAR: (style.VERMILION, "s", (0, (1, 1.2))),
    WITHOUT: (style.ORANGE, "^", (0, (5, 1.5))),
    FIELD: (style.PURPLE, "P", (0, (4, 1, 1, 1))),
    WITH: (style.BLUE, "o", "-"),
    CODE: (style.GREEN, "v", (0, (3, 1, 1, 1))),
    OWN: (style.GREY, "D", "-"),
}


def draw(*, table: Path) -> Figure:
    """Draw RMS errors of all references, and a part of a raster scan in time.

    Parameters
    ----------
    table : Path
        Errors, one row a reference and drive; the raster scan lies beside it.
    """
    rows = read_table(
        table, ("reference", "drive", "rms_percent", "unit"), "tracking error"
    )
    names = list(dict.fromkeys(row["reference"] for row in rows))
    figure = Figure(figsize=(style.PAGE, max(1.1 + 0.24 * len(names), 3.4)))
    grid = figure.add_gridspec(2, 2)
    left = figure.add_subplot(grid[:, 0])
    above, below = figure.add_subplot(grid[0, 1]), figure.add_subplot(grid[1, 1])
    above.sharex(below)
    _errors(left, rows, names)
    _scan(above, below, table.with_name("raster.csv"), rows[0]["unit"])
    left.set_title("error of each reference", loc="left")
    above.set_title(_title(names[-1]), loc="left")
    below.set_title("its error", loc="left")
    style.letter([left, above, below])
    style.legend_above(figure, left.get_lines()[: len(DRIVES)], columns=2)
    return figure


def _errors(axes: Axes, rows: Sequence[dict[str, str]], names: Sequence[str]) -> None:
    for drive, (color, marker, _) in LOOKS.items():
        own = [row for row in rows if row["drive"] == drive]
        axes.plot(
            [float(row["rms_percent"]) for row in own],
            [names.index(row["reference"]) for row in own],
            linestyle="none",
            marker=marker,
            color=color,
            label=DRIVES[drive],
        )
    axes.axvline(100 * GOAL, color=style.BLACK, linewidth=0.8, linestyle=":")
    axes.annotate(
        f"goal: {100 * GOAL:g} %",
        (100 * GOAL, 0.0),
        xycoords=axes.get_xaxis_transform(),
        xytext=(3, 3),
        textcoords="offset points",
        fontsize="small",
    )
    axes.set_xscale("log")
    axes.set_yticks(np.arange(len(names)), [_title(name) for name in names])
    axes.invert_yaxis()
    axes.set(xlabel="RMS error (% of the stroke)", ylabel="signal")


def _scan(above: Axes, below: Axes, table: Path, unit: str) -> None:
    rows = read_table(table, ("time_s", "reference", *DRIVES), "tracking error")
    columns = {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}
    time, reference = 1e3 * columns["time_s"], columns["reference"]
    above.plot(time, reference, **style.BEHIND)
    for drive, (color, _, dashes) in LOOKS.items():
        y = columns[drive]
        look: dict[str, Any] = {"color": color, "linestyle": dashes, "linewidth": 1.0}
        if drive != OWN:
            above.plot(time, y, **look)
        below.plot(time, 100 * (y - reference) / np.ptp(reference), **look)
    above.set(ylabel=f"displacement ({style.unit_text(unit)})")
    above.tick_params(labelbottom=False)
    below.set(xlabel="time (ms)", ylabel="error (% of the stroke)")


def _title(name: str) -> str:
    words = name.split("-")
    if words[0] == "raster":
        return f"raster, {words[1]} lines a second"
    return style.signal_title(name)
