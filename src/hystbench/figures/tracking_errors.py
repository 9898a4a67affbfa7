"""Open-loop tracking on the twin, with and without the inverse."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hystbench.figures import style
from hystbench.inverse.told import GOAL
from hystbench.inverse.tracking import DRIVES, LINEAR, OWN, WITH, WITHOUT, Tracked
from hystbench.record import Channel

LOOKS = {
    LINEAR: (style.VERMILION, "s", (0, (1, 1.2))),
    WITHOUT: (style.ORANGE, "^", (0, (5, 1.5))),
    WITH: (style.BLUE, "o", "-"),
    OWN: (style.GREY, "D", "-"),
}
SHOWN_S = 0.15
"""Time of the record that the right panels show."""


def draw(rows: Sequence[Tracked], output: Channel) -> Figure:
    """Draw RMS errors of all references, and one raster scan in time.

    Parameters
    ----------
    rows : sequence of Tracked
    output : Channel
        What the plant gives.
    """
    names = list(dict.fromkeys(row.reference.name for row in rows))
    figure = Figure(figsize=(style.PAGE, 1.1 + 0.24 * len(names)))
    grid = figure.add_gridspec(2, 2, width_ratios=(1.0, 1.0))
    left = figure.add_subplot(grid[:, 0])
    above, below = figure.add_subplot(grid[0, 1]), figure.add_subplot(grid[1, 1])
    above.sharex(below)
    _errors(left, rows, names)
    shown = [row for row in rows if row.reference.name == names[-1]]
    _scan(above, below, shown, output)
    left.set_title("RMS error of each reference", loc="left")
    above.set_title(f"{_title(names[-1])}", loc="left")
    below.set_title("its error", loc="left")
    style.letter([left, above, below])
    style.legend_above(figure, left.get_lines()[: len(DRIVES)], columns=2)
    return figure


def _errors(axes: Axes, rows: Sequence[Tracked], names: Sequence[str]) -> None:
    for drive, (color, marker, _) in LOOKS.items():
        own = [row for row in rows if row.drive == drive]
        axes.plot(
            [100 * row.rms for row in own],
            [names.index(row.reference.name) for row in own],
            linestyle="none",
            marker=marker,
            color=color,
            label=DRIVES[drive],
        )
    axes.axvline(100 * GOAL, color=style.BLACK, linewidth=0.8, linestyle=":")
    axes.annotate(
        f"{100 * GOAL:g} %",
        (100 * GOAL, 0.0),
        xycoords=axes.get_xaxis_transform(),
        xytext=(3, 3),
        textcoords="offset points",
        fontsize="small",
    )
    axes.set_xscale("log")
    axes.set_yticks(np.arange(len(names)), [_title(name) for name in names])
    axes.invert_yaxis()
    axes.set(xlabel="RMS error (% of the stroke)", ylabel="reference")


def _scan(above: Axes, below: Axes, rows: Sequence[Tracked], output: Channel) -> None:
    reference = rows[0].reference
    middle = len(reference.y) // 2
    count = min(round(SHOWN_S / reference.dt), len(reference.y) - middle)
    part = slice(middle, middle + count)
    time = 1e3 * np.arange(count) * reference.dt
    above.plot(time, reference.y[part], **style.BEHIND)
    for row in rows:
        color, _, dashes = LOOKS[row.drive]
        if row.drive != OWN:
            above.plot(time, row.y[part], color=color, linestyle=dashes, linewidth=1.0)
        off = 100 * (row.y - reference.y)[part] / row.stroke
        below.plot(time, off, color=color, linestyle=dashes, linewidth=1.0)
    above.set(ylabel=style.axis_label(output))
    above.tick_params(labelbottom=False)
    below.set(xlabel="time (ms)", ylabel="error (% of the stroke)")


def _title(name: str) -> str:
    words = name.split("-")
    if words[0] == "raster":
        return f"raster, {words[1]} lines a second"
    return style.signal_title(name)
