"""The score of a model: how it is made for one, and what a model scores."""

from __future__ import annotations

import numpy as np

from hystbench.gap.fitting.score import Products, Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.simulation.reshape import orthonormal
from hystbench.record import FloatArray


def make_score(state: ModelState, floor_rms: float, forms: bool = True) -> Score:
    """Give the score for a model: what could be wrong in its shape is spanned anew.

    Parameters
    ----------
    state : ModelState
    floor_rms : float
    forms : bool
        Whether the added effects may be of another form too; not when their own
        numbers are to be found.
    """
    shape = state.wrong_shape
    directions = directions_of(shape, state) if forms else shape
    return Score(state.sample, directions, floor_rms**2)


def directions_of(wrong_shape: FloatArray, state: ModelState) -> FloatArray:
    """Give a wrong shape's directions with other forms of what a model has added."""
    forms = state.other_forms
    return (
        orthonormal(np.hstack([wrong_shape, forms])) if forms.shape[1] else wrong_shape
    )


def score_of(state: ModelState, score: Score) -> float:
    """Score a model as it is; amplitudes of what lies beside are solved for."""
    return score_beside(state, score, beside_of(state, score))


def beside_of(state: ModelState, score: Score) -> Products | None:
    """Give the products of what lies beside a model; None without."""
    if not state.beside:
        return None
    columns = state.beside_columns
    return score.shared(columns, np.zeros(columns.shape[1]))


def score_beside(state: ModelState, score: Score, beside: Products | None) -> float:
    """Score a model where the products of what lies beside it are known."""
    nothing = np.zeros((len(state.sample), 0))
    return score.amplitudes(state.residual, nothing, state.freedom, beside=beside).score
