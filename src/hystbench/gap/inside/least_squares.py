"""Fitting all free numbers of a model together, by Levenberg and Marquardt's steps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from hystbench.errors import InputError
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.thresholds import SCALE
from hystbench.record import FloatArray

EVALUATIONS = 100
"""Of the residual in one fit, at most, without those of the derivatives."""
QUICK = 15
"""The same where starts are compared."""
STEP = 1e-5
"""Share of its size by which a number moves for a derivative."""
REACH = 1.0
"""How far the first step may go: numbers change by a factor of e, or by their size."""
FACTOR = 100.0
"""How many times the scale of the numbers MINPACK's first step may go."""
SMALL = 1e-4
"""Share by which a step must lower the squares, or move the numbers, for another to
follow: the score changes by less than a tenth of what a number costs."""
OUT = 1e3
"""Residual, in times of the output's size, of a model that runs away."""


@dataclass(frozen=True)
class Fitted:
    """A model whose numbers were fitted.

    Parameters
    ----------
    state : ModelState
    score : float
    """

    state: ModelState
    score: float


def fitted(
    state: ModelState,
    score: Score,
    evaluations: int = EVALUATIONS,
) -> Fitted:
    """Fit the free numbers of a model to its records.

    Each record counts alike: its residual is divided by its rms before. A number that
    cannot be negative is fitted by its logarithm.

    Parameters
    ----------
    state : ModelState
    score : Score
        Judges the result.
    evaluations : int
    """
    if not state.free:
        return Fitted(state, judged(state, score))
    from scipy.optimize import leastsq  # late: a start alone needs none of it

    sizes = _sizes(state)
    logs = np.array([_positive(state, free) for free in state.free], dtype=bool)
    values = np.array([state.value(free) for free in state.free])
    weights = by_record(state)
    most = OUT * weights * float(np.max(np.abs(state.measured)))

    def values_at(point: FloatArray) -> FloatArray:
        times = np.exp(np.clip(point, -100, 100))
        return np.where(logs, values * times, values + point * sizes)

    def moved(point: FloatArray) -> ModelState:
        return at_values(state, values_at(point)) if point.any() else state

    def weighed(rest: FloatArray) -> FloatArray:
        rest = rest * weights
        return np.where(np.isfinite(rest), np.clip(rest, -most, most), most)

    def residual(point: FloatArray) -> FloatArray:
        try:
            return weighed(moved(point).residual)
        except InputError:
            return most  # out of what the blocks accept

    def slopes(point: FloatArray) -> FloatArray:
        found = outputs_near(moved(point), dict(enumerate(values_at(point + STEP))))
        now, *others = (weighed(state.reference - output) for output in found)
        return np.column_stack([(other - now) / STEP for other in others])

    start = np.zeros(len(values))
    first = slopes(start)  # MINPACK's wrapper asks for it once more, to see its shape
    point, *_ = leastsq(
        residual,
        start,
        Dfun=lambda point: slopes(point) if point.any() else first,
        full_output=True,
        maxfev=evaluations,
        xtol=SMALL,
        ftol=SMALL,
        diag=np.full(len(values), FACTOR / REACH),
    )
    best = moved(point)
    return Fitted(best, judged(best, score))


def fitted_to_the_end(state: ModelState, score: Score) -> Fitted:
    """Fit as :func:`fitted`, again from there while the score falls by what matters.

    Each record counts by what was left of it before a fit: where that changed much, the
    next one weighs otherwise.
    """
    best = fitted(state, score)
    while (again := fitted(best.state, score)).score < best.score - SCALE:
        best = again
    return best


def judged(state: ModelState, score: Score) -> float:
    """Score a model; one that runs away has an infinite score."""
    residual = state.residual
    if not np.all(np.isfinite(residual)):
        return float("inf")
    return score.of(residual, state.freedom)


def at_values(state: ModelState, values: FloatArray) -> ModelState:
    """Give a model with other values of its free numbers, within their bounds.

    Raises
    ------
    InputError
        If a block does not take them together.
    """
    return state.with_chain(state.chain_at(dict(enumerate(values.tolist()))))


def outputs_near(state: ModelState, values: Mapping[int, float]) -> FloatArray:
    """Simulate a model, and with each of some free numbers at a value near its own.

    With a value that a block does not take it is as it was.

    Parameters
    ----------
    state : ModelState
    values : mapping of int to float
        By place in ``free``.

    Returns
    -------
    ndarray, shape (1 + values, scored samples)
    """
    chains = []
    for k, value in values.items():
        try:
            chains.append(state.chain_at({k: value}))
        except InputError:
            chains.append(state.chain)
    return state.sample.take(state.simulation.near(chains)).T


def _positive(state: ModelState, free: Free) -> bool:
    about = state.chain[free.block].parameters()[free.parameter]
    return about.low >= 0.0 and state.value(free) > 0.0


def by_record(state: ModelState) -> FloatArray:
    """Give one over the rms of the residual of each record, for all its samples."""
    weights = np.empty(len(state.measured))
    residual = np.where(np.isfinite(state.residual), state.residual, state.measured)
    for part in state.sample.slices:
        weights[part] = 1.0 / max(float(np.sqrt(np.mean(residual[part] ** 2))), 1e-300)
    return weights


def _sizes(state: ModelState) -> FloatArray:
    """What is a large change of each number that may have either sign.

    Its own value; of a zero, what moves the output by its own rms.
    """
    sizes = np.ones(len(state.free))
    now = np.array([state.value(free) for free in state.free])
    signed = [k for k, free in enumerate(state.free) if not _positive(state, free)]
    steps = np.where(now == 0.0, 1e-6, 1e-3 * np.abs(now))
    output, *others = outputs_near(state, {k: now[k] + steps[k] for k in signed})
    rms = float(np.sqrt(np.mean(state.measured**2)))
    for k, other in zip(signed, others, strict=True):
        moved = float(np.sqrt(np.mean((other - output) ** 2)))
        reach = rms * steps[k] / moved if np.isfinite(moved) and moved > 0 else 1.0
        sizes[k] = max(abs(now[k]), 0.1 * reach) if now[k] else 0.1 * reach
    return sizes
