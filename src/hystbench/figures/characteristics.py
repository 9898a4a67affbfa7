"""Figures 3 and 4: input and output of the operators, with arrows along the curves."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hystbench.envelope import PUBLISHED_ENVELOPE, thresholds
from hystbench.figures import style
from hystbench.operators import generalized_play, play
from hystbench.published import load_text
from hystbench.record import FloatArray

# Amplitudes of the two loops of Figure 3, in thresholds.
_LARGE, _SMALL = 3.0, 1.9
# The operator in the middle of a small bank has a loop that shows both envelopes.
_ORDER, _OPERATOR = 3, 1


def draw_play() -> Figure:
    """Draw a large and a small loop of the play operator (Eqs. 1 and 2).

    Input and output are given in thresholds r.
    """
    figure = Figure(figsize=(style.COLUMN, 2.9))
    axes = figure.subplots()
    for amplitude, color, dashes in (
        (_LARGE, style.BLUE, "-"),
        (_SMALL, style.VERMILION, (0, (4, 2))),
    ):
        # From rest at the lower end, so that the loop is closed.
        v = _there_and_back(amplitude)
        outputs = play(v, [1.0], state=[1.0 - amplitude])
        w = outputs[:, 0]
        label = f"amplitude {amplitude:g} $r$"
        axes.plot(v, w, color=color, linestyle=dashes, linewidth=1.4, label=label)
        _arrows(axes, v, w, (0.09, 0.36, 0.59, 0.86), color)
    for sign, name, align in ((-1, "$w = v - r$", "left"), (1, "$w = v + r$", "right")):
        axes.annotate(
            name,
            (-0.55 * sign, -0.55 * sign + sign),
            xytext=(-8 * sign, 0),
            textcoords="offset points",
            horizontalalignment=align,
            verticalalignment="center",
        )
    axes.set(
        xlabel="input $v / r$ (-)",
        ylabel="output $w / r$ (-)",
        xticks=range(-3, 4),
        yticks=range(-2, 3),
    )
    style.legend_above(figure, axes.get_lines())
    return figure


def draw_generalized_play() -> Figure:
    """Draw one generalized play with the published envelopes (Eqs. 3 and 4)."""
    figure = Figure(figsize=(style.COLUMN, 2.9))
    axes = figure.subplots()
    envelope, amplitude = PUBLISHED_ENVELOPE, load_text().amplitude_a
    r = thresholds(envelope, amplitude, _ORDER)[_OPERATOR]
    # At the lower end Eq. 4 takes the state from zero to the left envelope: the loop.
    v = _there_and_back(amplitude)
    outputs = generalized_play(envelope.left(v), envelope.right(v), [r])
    w = outputs[:, 0]

    grid = np.linspace(-amplitude, amplitude, 201)
    for y, color, dashes, label in (
        (envelope.left(grid) + r, style.VERMILION, (4, 2), r"$\gamma_l(v) + r$"),
        (envelope.right(grid) - r, style.GREEN, (1, 1.2), r"$\gamma_r(v) - r$"),
    ):
        axes.plot(grid, y, color=color, linestyle=(0, dashes), label=label)
    axes.plot(v, w, color=style.BLUE, linewidth=1.6, label="output $w$")
    _arrows(axes, v, w, (0.09, 0.4, 0.59, 0.9), style.BLUE)
    axes.set(xlabel="input $v$ (A)", ylabel="output $w$ (-)")
    style.legend_above(figure, axes.get_lines())
    return figure


def _there_and_back(amplitude: float) -> FloatArray:
    """Make an input that goes straight up from the lower end, and back."""
    turns = (-amplitude, amplitude, -amplitude)
    return np.concatenate([np.linspace(a, b, 401) for a, b in pairwise(turns)])


def _arrows(
    axes: Axes, x: FloatArray, y: FloatArray, places: Sequence[float], color: str
) -> None:
    """Set arrow heads along a curve, at fractions of its samples."""
    head = {"arrowstyle": "-|>", "color": color, "mutation_scale": 11}
    for place in places:
        at = round(place * (len(x) - 1))
        axes.annotate(
            "",
            xy=(x[at], y[at]),
            xytext=(x[at - 12], y[at - 12]),
            arrowprops={**head, "shrinkA": 0, "shrinkB": 0, "linewidth": 0},
        )
