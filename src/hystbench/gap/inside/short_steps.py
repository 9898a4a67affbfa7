"""Numbers of forces that were fitted by long steps, fitted anew by short ones."""

from __future__ import annotations

import numpy as np

from hystbench.gap.fitting.least_squares import QUICK, fitted
from hystbench.gap.fitting.model_score import score_of
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.thresholds import PARAMETER, PAYS
from hystbench.record import FloatArray

MOVED = 1e-3
"""Share that each number is moved by at first: about what a fit leaves open."""
MOST_TRIALS = 50
"""Models that are simulated, for each number."""


def in_short_steps(state: ModelState, score: Score) -> ModelState:
    """Fit the numbers of forces anew by short steps; long ones make up for themselves.

    What the long steps miss is taken from where the numbers are, so twice is enough.
    Numbers stay where they are if another place gains less than a number costs.
    """
    long = score_of(state, score)
    state = state.settled()
    if score_of(state, score) > long + PAYS:
        state = of_the_same_motion(state, score)
    for _ in range(2):
        again = fitted(state, score, QUICK).state.settled()
        if score_of(again, score) > score_of(state, score) - PARAMETER:
            break
        state = again
    return state


def of_the_same_motion(state: ModelState, score: Score) -> ModelState:
    """Move numbers a little, till the records' motion is the one that is simulated.

    Where two motions are possible, as of a mass that meets a stiff stop or does not,
    hardly anything decides between them, and the length of the steps may. There are no
    slopes then: the search is Nelder and Mead's.
    """
    begun = np.array([state.value(free) for free in state.free])
    low, high = np.array([(free.low, free.high) for free in state.free]).T

    def at(moved: FloatArray) -> ModelState:
        numbers = np.clip(begun * (1 + moved), low, high)
        return state.at(dict(enumerate(numbers.tolist()))).settled()

    from scipy.optimize import minimize  # late: most motions are one

    still = np.zeros(len(begun))
    found = minimize(
        lambda moved: score_of(at(moved), score),
        still,
        method="Nelder-Mead",
        options={
            "initial_simplex": np.vstack([still, MOVED * np.eye(len(begun))]),
            "maxfev": MOST_TRIALS * len(begun),
            "fatol": PARAMETER,
            "xatol": MOVED,
        },
    )
    return at(found.x)
