"""The score of a model: how it is made for one, what it scores, and where it ends.

It ends at a floor: noise, and what the simulator's steps miss.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from hystbench.gap.fitting.score import Score, Shared
from hystbench.gap.fitting.state import ROUNDING, ModelState
from hystbench.gap.records.floor import Floor
from hystbench.gap.simulation.reshape import closing_reshapings, orthonormal
from hystbench.gap.simulation.shared import Same
from hystbench.gap.simulation.simulation import Simulation
from hystbench.gap.thresholds import AS_GOOD
from hystbench.metrics import rms
from hystbench.record import FloatArray

LEAST = float(np.finfo(float).tiny)
"""Least floor, where the output is zero: the score has its logarithm."""


def make_score(state: ModelState, floor: Floor, forms: bool = True) -> Score:
    """Give the score for a model: what could be wrong in its shape is spanned anew.

    Parameters
    ----------
    state : ModelState
    floor : Floor
    forms : bool
        Whether the added effects may be of another form too; not when their own
        numbers are to be found.
    """
    shape = state.wrong_shape
    directions = directions_of(shape, state) if forms else shape
    return Score(state.sample, directions, floor.square)


def leaves_more(state: ModelState, base: ModelState, square: float) -> bool:
    """Tell whether a model leaves more of the records than a base, as is said of both.

    By over `AS_GOOD`, as on hold-out records. The score may fall all the same: it is a
    sum of logarithms, and takes much less of one record for a little more of another.

    Parameters
    ----------
    state : ModelState
    base : ModelState
        On the same records.
    square : float
        Of the noise floor.
    """
    left, before = (x.power(square) + square for x in (state, base))
    return left > (1.0 + AS_GOOD) * before


def score_of_numbers(state: ModelState, floor: Floor) -> Score:
    """Give the score by which the numbers of a model are found in the end.

    The score is flat below its floor. Where the noise is known only by an upper bound,
    that bound may lie above what the model leaves. So the floor is at most half of what
    the model leaves of any record: a few numbers cannot take more than half of noise.

    Where another shape of the hysteresis was named, the score ignores nothing that a
    shape could do. Elsewhere it ignores what loops that close could do, but not what
    loops that forget could do (:func:`closing_reshapings` says why).

    Parameters
    ----------
    state : ModelState
        With all that was named.
    floor : Floor
    """
    square = min(floor.square, float(np.min(state.squares)) / 2)
    rounded = (ROUNDING * rms(state.measured)) ** 2
    square = max(square, rounded, LEAST)
    if state.has_shape:
        return Score.plain(state.sample, square)
    shape = closing_reshapings(state.simulation, state.sample)
    return Score(state.sample, orthonormal(shape), square)


def directions_of(wrong_shape: FloatArray, state: ModelState) -> FloatArray:
    """Give a wrong shape's directions with other forms of what a model has added."""
    forms = state.other_forms
    return (
        orthonormal(np.hstack([wrong_shape, forms])) if forms.shape[1] else wrong_shape
    )


def score_of(state: ModelState, score: Score) -> float:
    """Score a model as it is, with what its moved numbers cost.

    Amplitudes of what lies beside are solved for.
    """
    nothing, beside = np.zeros((len(state.sample), 0)), beside_of(state, score)
    found = score.amplitudes(state.residual, nothing, state.freedom, beside=beside)
    return found.score + state.moved_charge


def beside_of(state: ModelState, score: Score) -> Shared | None:
    """Give the products of what lies beside a model; None if nothing does."""
    if not state.beside:
        return None
    return _products(Same(state.beside, state.records, state.sample), score)


@lru_cache(maxsize=2)
def _products(given: Same, score: Score) -> Shared:
    """Give them for all chains that the same lies beside."""
    beside, records, sample = given.objects
    columns = ModelState((), records, sample, beside=beside).beside_columns
    return score.shared(columns)


def step_error(state: ModelState) -> float | None:
    """Measure what the plain simulation misses by its steps, RMS over scored samples.

    The state's own residual is that of a simulation in short steps. None where the
    chain holds a simulator whose inside is not seen: nobody knows its steps.
    """
    if not all(block.seen for block in state.chain):
        return None
    plain = state.sample.take(Simulation(state.chain, state.records, state.hold).output)
    return rms(plain - (state.measured - state.residual))


def floor_with_steps(noise_rms: float, error: float | None) -> float:
    """Give the RMS of noise and step error together: neither knows of the other.

    Where the step error is not known it is that of the noise.
    """
    return noise_rms if error is None else float(np.hypot(noise_rms, error))


def above_floor(state: ModelState, score: Score) -> float:
    """Tell how much could be gained in the score if all went that is no noise or step.

    The score's own floor is that of the noise.
    """
    floor = floor_with_steps(float(np.sqrt(score.floor)), step_error(state)) ** 2
    whole = replace(score, floor=floor)
    return score_of(state, whole) - whole.least(state.freedom)
