"""What was answered first for each hidden effect of the blind contest."""

from pathlib import Path

import numpy as np
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from hystbench.compare.rows import read_rows
from hystbench.errors import InputError
from hystbench.figures import style

_COLUMNS = ("kind", "hidden", "answered", "right", "cases")
#: Answers that are no effect, at the right end.
_LAST = ("no-gap", "unnamed", "parameters", "lost")
_RIGHT = LinearSegmentedColormap.from_list("right", ["white", style.GREEN])
_WRONG = LinearSegmentedColormap.from_list("wrong", ["white", style.VERMILION])


def draw(*, table: Path) -> Figure:
    """Draw the confusion matrix: a row a hidden effect, a column a first answer.

    Colour goes with the root of the share of the row's cases; in each cell stands how
    many there are.

    Parameters
    ----------
    table : Path
        ``kind, hidden, answered, right, cases``.
    """
    rows = read_rows(table, _COLUMNS)
    if not rows:
        raise InputError(f"{table}: no case of the blind contest")
    lines = list(dict.fromkeys(row["hidden"] for row in rows))
    listed = [row["hidden"] for row in rows if row["kind"] == "single"]
    answers = {row["answered"] for row in rows}
    columns = [
        *sorted((answers | set(listed)) - set(_LAST)),
        *(name for name in _LAST if name in answers),
    ]
    counts = np.zeros((len(lines), len(columns)))
    right = np.zeros_like(counts)
    for row in rows:
        place = lines.index(row["hidden"]), columns.index(row["answered"])
        counts[place] += int(row["cases"])
        if row["right"] == "yes":
            right[place] += int(row["cases"])

    figure = Figure(figsize=(style.PAGE, 2.2 + 0.17 * len(lines)))
    axes = figure.subplots()
    axes.grid(visible=False)
    axes.tick_params(length=0)
    # the root: few wrong answers among many are to be seen
    share = np.sqrt(counts / counts.sum(axis=1, keepdims=True))
    mostly = (right >= 0.5 * counts)[:, :, np.newaxis]
    colours = np.where(mostly, _RIGHT(share), _WRONG(share))
    axes.imshow(colours, aspect="auto", interpolation="nearest")
    for (i, j), count in np.ndenumerate(counts):
        if count:
            axes.text(j, i, f"{count:.0f}", ha="center", va="center", fontsize=6)
    axes.set_xticks(range(len(columns)), columns, rotation=90)
    axes.set_yticks(range(len(lines)), lines)
    axes.set_xlabel("first answer")
    axes.set_ylabel("hidden effect")
    patch = {"marker": "s", "markersize": 6, "linestyle": "none"}
    counted = "right (number of cases in each cell)"
    right_key = style.key(counted, color=style.GREEN, **patch)
    wrong_key = style.key("wrong", color=style.VERMILION, **patch)
    style.legend_above(figure, [right_key, wrong_key])
    return figure
