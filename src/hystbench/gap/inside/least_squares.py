"""Fitting all free numbers of a model together, by Levenberg and Marquardt's steps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hystbench.errors import InputError
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.record import FloatArray

EVALUATIONS = 100
"""Of the residual in one fit, at most, without those of the derivatives."""
QUICK = 15
"""The same where starts are compared."""
STEP = 1e-3
"""Share of its size by which a number moves for a derivative: more than what a force
that is not smooth makes of rounding."""
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
    from scipy.optimize import least_squares  # late: a start alone needs none of it

    sizes = _sizes(state)
    logs = np.array([_positive(state, free) for free in state.free], dtype=bool)
    values = np.array([state.value(free) for free in state.free])
    weights = by_record(state)
    most = OUT * weights * float(np.max(np.abs(state.measured)))

    def moved(point: FloatArray) -> ModelState:
        times = np.exp(np.clip(point, -100, 100))
        found = np.where(logs, values * times, values + point * sizes)
        return at_values(state, found)

    newest: dict[bytes, FloatArray] = {}  # that of one point: slopes begin with it

    def residual(point: FloatArray) -> FloatArray:
        key = point.tobytes()
        if key not in newest:
            newest.clear()
            newest[key] = weighed(point)
        return newest[key]

    def weighed(point: FloatArray) -> FloatArray:
        try:
            rest = moved(point).residual * weights
        except InputError:
            return most  # out of what the blocks accept
        return np.where(np.isfinite(rest), np.clip(rest, -most, most), most)

    def slopes(point: FloatArray) -> FloatArray:
        now = residual(point)
        steps = STEP * np.eye(len(point))
        return np.column_stack([(residual(point + s) - now) / STEP for s in steps])

    found = least_squares(
        residual,
        np.zeros(len(values)),
        slopes,
        method="lm",  # a trust region would take a singular value decomposition a step
        x_scale=np.full(len(values), REACH / FACTOR),
        max_nfev=evaluations,
        xtol=SMALL,
        ftol=SMALL,
    )
    best = moved(found.x)
    return Fitted(best, judged(best, score))


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
    all_now = np.array([state.value(free) for free in state.free])
    now = state.residual
    rms = float(np.sqrt(np.mean(state.measured**2)))
    for k, free in enumerate(state.free):
        if _positive(state, free):
            continue
        value = abs(all_now[k])
        step = 1e-3 * value if value else 1e-6
        values = all_now.copy()
        values[k] += step
        try:
            change = at_values(state, values).residual - now
        except InputError:
            change = np.full(len(now), np.nan)
        moved = float(np.sqrt(np.mean(change**2)))
        reach = rms * step / moved if np.isfinite(moved) and moved > 0 else 1.0
        sizes[k] = max(value, 0.1 * reach) if value else 0.1 * reach
    return sizes
