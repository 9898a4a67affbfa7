"""Curves with arrows along them, for the operators' characteristics."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes

from hystbench.record import FloatArray


def sweep(turns: Sequence[float], samples: int = 401) -> FloatArray:
    """Make an input that goes straight from one turning point to the next."""
    parts = [np.linspace(start, stop, samples) for start, stop in pairwise(turns)]
    return np.concatenate(parts)


def arrows(
    axes: Axes, x: FloatArray, y: FloatArray, places: Sequence[float], color: str
) -> None:
    """Set arrow heads along a curve.

    Parameters
    ----------
    axes : Axes
        Where the curve is drawn.
    x, y : ndarray, shape (n,)
        The curve.
    places : sequence of float
        Where the heads stand, as fractions of the samples.
    color : str
        Colour of the curve.
    """
    for place in places:
        head = round(place * (len(x) - 1))
        axes.annotate(
            "",
            xy=(x[head], y[head]),
            xytext=(x[head - 12], y[head - 12]),
            arrowprops={
                "arrowstyle": "-|>",
                "color": color,
                "mutation_scale": 11,
                "shrinkA": 0,
                "shrinkB": 0,
                "linewidth": 0,
            },
        )
