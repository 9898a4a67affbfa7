"""Whether a law of plays has a loop, or bends to a curve that has none."""

from __future__ import annotations

import numpy as np

from hystbench.gap.effects.hysteresis import Hysteresis
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.thresholds import UNNAMED_SHARE
from hystbench.record import FloatArray

KNOTS = 30
"""Where the curve bends: as many samples between two of them."""


def is_a_curve(state: ModelState, effect: str) -> bool:
    """Tell whether an effect of a model is a hysteresis without a loop.

    Many plays bend to any curve, as to a dead zone with a limit. Of what such a law
    adds to a line a curve then leaves no more than may stay unnamed.

    Parameters
    ----------
    state : ModelState
    effect : str
        One that was added to it.
    """
    if effect != Hysteresis.name:
        return False
    blocks = [item.blocks for item in state.added if item.effect == effect]
    if not blocks:
        return False
    (place,) = blocks[0]
    simulation = state.simulation
    entered = np.concatenate(simulation.at(place))
    left = np.concatenate(simulation.at(place + 1))
    line = np.column_stack([np.ones(len(entered)), entered])
    bent = np.maximum(entered[:, None] - _knots(entered), 0.0)
    of_line, of_curve = (_left(x, left) for x in (line, np.hstack([line, bent])))
    return of_curve <= UNNAMED_SHARE * of_line


def _knots(signal: FloatArray) -> FloatArray:
    every = np.quantile(signal, np.linspace(0.0, 1.0, KNOTS + 2))[1:-1]
    return np.unique(every)


def _left(columns: FloatArray, signal: FloatArray) -> float:
    """Give the mean square that columns leave of a signal."""
    numbers = np.linalg.lstsq(columns, signal, rcond=None)[0]
    return float(np.mean((signal - columns @ numbers) ** 2))
