"""Better numbers of effects before a simulator of somebody's own, without slopes."""

from __future__ import annotations

import numpy as np

from hystbench.blocks.calls import CallsUsedUp
from hystbench.blocks.simulator import Simulator
from hystbench.errors import InputError
from hystbench.gap.fitting.model_score import make_score, score_of
from hystbench.gap.fitting.refit import refit
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.thresholds import SCALE

RANGE = 1.5
"""Times a number, up and down, that is looked over."""
LOOKS = 16
"""Simulations a number at most."""


def scanned(state: ModelState, floor_rms: float) -> ModelState:
    """Look over the numbers of effects before a simulator, one after the other.

    What a simulator of relays or of rounded numbers gives is a staircase of what it
    takes: the slope over a small step says nothing, and a refit stays where it began.

    Parameters
    ----------
    state : ModelState
    floor_rms : float

    Returns
    -------
    ModelState
        The same where nothing scores better by more than a tie, as where no effect
        stands before a simulator.
    """
    last = max(
        (k for k, block in enumerate(state.chain) if isinstance(block, Simulator)),
        default=-1,
    )
    own = {place for item in state.added for place in item.blocks if place < last}
    places = [
        k
        for k, free in enumerate(state.free)
        if free.block in own and free.element is None and state.value(free) != 0.0
    ]
    if not places:
        return state
    from scipy.optimize import minimize_scalar  # late: few searches need it

    score = make_score(state, floor_rms, forms=False)
    best, found = score_of(state, score), state
    for k in places:
        value, free = found.value(found.free[k]), found.free[k]
        ends = sorted((value / RANGE, value * RANGE))
        low, high = np.clip(ends, free.low, free.high).tolist()

        def at(number: float, from_: ModelState = found, k: int = k) -> float:
            try:
                return score_of(from_.with_chain(from_.chain_at({k: number})), score)
            except CallsUsedUp:  # half a look decides nothing
                raise
            except InputError:  # out of what the simulator takes: no candidate
                return np.inf

        about = {"maxiter": LOOKS, "xatol": 1e-3 * (high - low)}
        there = minimize_scalar(at, bounds=(low, high), method="bounded", options=about)
        if there.fun < best - SCALE:
            moved = found.with_chain(found.chain_at({k: float(there.x)}))
            found, best = refit(moved, score)
    return found
