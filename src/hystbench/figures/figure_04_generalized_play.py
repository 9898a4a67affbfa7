"""Figure 4: input and output of the generalized play operator (Eqs. 3 and 4)."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from hystbench.envelope import PUBLISHED_ENVELOPE, thresholds
from hystbench.figures import style
from hystbench.figures.arrows import arrows, sweep
from hystbench.operators import generalized_play
from hystbench.published import load_text

# The operator in the middle of a small bank has a loop that shows both envelopes.
_ORDER, _OPERATOR = 3, 1


def draw() -> Figure:
    """Draw one operator with the published envelope functions."""
    figure = Figure(figsize=(style.COLUMN, 2.9))
    axes = figure.subplots()
    amplitude = load_text().amplitude_a
    r = thresholds(PUBLISHED_ENVELOPE, amplitude, _ORDER)[_OPERATOR]
    # At the lower end Eq. 4 takes the state from zero to the left envelope: the loop.
    v = sweep([-amplitude, amplitude, -amplitude])
    left, right = PUBLISHED_ENVELOPE.left(v), PUBLISHED_ENVELOPE.right(v)
    outputs, _ = generalized_play(left, right, [r])
    w = outputs[:, 0]

    grid = np.linspace(-amplitude, amplitude, 201)
    axes.plot(
        grid,
        PUBLISHED_ENVELOPE.left(grid) + r,
        color=style.VERMILION,
        linestyle=(0, (4, 2)),
        label=r"$\gamma_l(v) + r$",
    )
    axes.plot(
        grid,
        PUBLISHED_ENVELOPE.right(grid) - r,
        color=style.GREEN,
        linestyle=(0, (1, 1.2)),
        label=r"$\gamma_r(v) - r$",
    )
    axes.plot(v, w, color=style.BLUE, linewidth=1.6, label="output $w$")
    arrows(axes, v, w, (0.09, 0.4, 0.59, 0.9), style.BLUE)
    axes.set(xlabel="input $v$ (A)", ylabel="output $w$ (-)")
    style.legend_above(figure, axes.get_lines())
    return figure
