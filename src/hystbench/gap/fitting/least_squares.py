"""Fitting all free numbers of a model from far off, by Levenberg and Marquardt's steps.

It goes far: a force inside the dynamics starts where it does little, and generalized
plays where they hardly bend. What is lowered is a sum of squares, and steps are as long
as the last ones were good for. A refit starts near, and lowers the score itself, beside
amplitudes that are solved for: see :mod:`hystbench.gap.fitting.refit`. Neither does the
other's work.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from hystbench.errors import InputError
from hystbench.gap.fitting.minpack import least_squares_point
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.thresholds import SCALE
from hystbench.record import FloatArray

EVALUATIONS = 100
"""Most evaluations of the residual in one fit, without those of the derivatives."""
QUICK = 15
"""The same where starts are compared."""
STEP = 1e-5
"""Share of its size by which a number moves for a derivative."""
NOTHING = 1e-6
"""Move of a number that is zero."""
REACH = 1.0
"""How far the first step may go: numbers change by a factor of e, or by their size."""
FACTOR = 100.0
"""How many times the scale of the numbers MINPACK's first step may go."""
SMALL = 1e-4
"""Share by which a step must lower the squares, or move the numbers, for another to
follow: the score changes by less than a tenth of what a number costs."""
NO_REST = 1e-6
"""Share of what is left of all records, rms, below which nothing is left of one."""
OUT = 1e3
"""Residual, in times of the output's size, of a model that runs away."""


@dataclass(frozen=True)
class Fitted:
    """A model whose numbers were fitted."""

    state: ModelState
    score: float

    @property
    def effects(self) -> tuple[str, ...]:
        """Its effects, in the order in which they were put in."""
        return tuple(item.effect for item in self.state.added)

    @property
    def forms(self) -> tuple[str, ...]:
        """Law of each."""
        return tuple(item.form for item in self.state.added)

    @property
    def laws(self) -> frozenset[tuple[str, str]]:
        """Its effects with their laws, in whatever order they were put in."""
        return frozenset(zip(self.effects, self.forms, strict=True))


def fitted(
    state: ModelState,
    score: Score,
    evaluations: int = EVALUATIONS,
) -> Fitted:
    """Fit the free numbers of a model to its records.

    Each record counts alike: its residual is divided by its rms before. A number that
    cannot be negative is fitted by its logarithm. A number of a known tolerance is held
    by it, as a measured value is by its standard error.

    Parameters
    ----------
    state : ModelState
    score : Score
        Judges the result.
    evaluations : int
    """
    if not state.free:
        return Fitted(state, judged(state, score))
    logs = np.array([_positive(state, free) for free in state.free], dtype=bool)
    values = np.array([state.value(free) for free in state.free])
    steps = np.where(values == 0.0, NOTHING, STEP * np.abs(values))
    tangents = _tangents(state, steps)
    sizes = np.where(logs, values, _large_changes(state, values, tangents))
    weights = record_weights(state)
    most = OUT * weights * float(np.max(np.abs(state.measured)))
    known = np.flatnonzero(state.held.stiffness)
    given = (values - state.held.moved)[known]
    # What is lowered is, near its least, the score times samples by what they weigh.
    samples = len(weights) / len(state.sample.slices)
    per_unit = np.sqrt(samples / score.weight * state.held.stiffness[known])

    def values_at(point: FloatArray) -> FloatArray:
        times = np.exp(np.clip(point, -100, 100))
        return np.where(logs, values * times, values + point * sizes)

    @lru_cache(maxsize=2)  # slopes are asked for where the residual was
    def at(point: bytes) -> ModelState:
        return state.at(dict(enumerate(values_at(np.frombuffer(point)).tolist())))

    def moved(point: FloatArray) -> ModelState:
        return at(point.tobytes()) if point.any() else state

    def residual(point: FloatArray) -> FloatArray:
        try:
            rest = moved(point).residual * weights
        except InputError:
            rest = most  # out of what the blocks accept
        rest = np.where(np.isfinite(rest), np.clip(rest, -most, most), most)
        return np.append(rest, (values_at(point)[known] - given) * per_unit)

    def slopes(point: FloatArray) -> FloatArray:
        # MINPACK's wrapper asks for the first ones once more, to see their shape.
        scale, own = sizes, tangents
        if point.any():
            scale = np.where(logs, values_at(point), sizes)
            own = _tangents(moved(point), STEP * scale)
        held = np.zeros((len(known), len(scale)))
        held[np.arange(len(known)), known] = scale[known] * per_unit
        return np.vstack([-weights[:, None] * own * scale, held])

    point = least_squares_point(
        residual,
        slopes,
        len(values),
        scale=FACTOR / REACH,
        evaluations=evaluations,
        enough=SMALL,
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
    """Score a model, with what moved numbers cost; infinite if it runs away."""
    residual = state.residual
    if not np.all(np.isfinite(residual)):
        return float("inf")
    return score.of(residual, state.freedom) + state.moved_charge


def _tangents(state: ModelState, steps: FloatArray) -> FloatArray:
    """How the output changes with each free number, shape (scored samples, k).

    By differences of so much; none with a number that a block does not take, nor where
    the motion runs away.
    """
    # At the upper end of its range a number is moved down.
    at_end = np.array(
        [
            state.value(free) + step > free.high
            for free, step in zip(state.free, steps.tolist(), strict=True)
        ],
        dtype=bool,
    )
    steps = np.where(at_end, -steps, steps)
    chains = []
    for k, step in enumerate(steps.tolist()):
        try:
            chains.append(state.moved({k: step}).chain)
        except InputError:
            chains.append(state.chain)
    found = state.sample.take(state.simulation.near(chains))
    change = found[:, 1:] - found[:, :1]
    return np.where(np.isfinite(change), change, 0.0) / steps


def _positive(state: ModelState, free: Free) -> bool:
    about = state.chain[free.block].parameters()[free.parameter]
    return about.low >= 0.0 and state.value(free) > 0.0


def record_weights(state: ModelState) -> FloatArray:
    """Give one over the rms of the residual of each record, for all its samples.

    Where an output stands still a model may leave nothing.
    """
    weights = np.empty(len(state.measured))
    residual = np.where(np.isfinite(state.residual), state.residual, state.measured)
    least = max(NO_REST * float(np.sqrt(np.mean(residual**2))), 1e-300)
    for part in state.sample.slices:
        weights[part] = 1.0 / max(float(np.sqrt(np.mean(residual[part] ** 2))), least)
    return weights


def _large_changes(
    state: ModelState, values: FloatArray, tangents: FloatArray
) -> FloatArray:
    """What is a large change of each number that may have either sign.

    Its own value, or what moves the output by a tenth of its own rms.
    """
    output = float(np.sqrt(np.mean(state.measured**2)))
    moved = np.sqrt(np.mean(tangents**2, axis=0))
    tenth = 0.1 * np.where(moved > 0, output / np.where(moved > 0, moved, 1.0), 1.0)
    return np.where(values == 0.0, tenth, np.maximum(np.abs(values), tenth))
