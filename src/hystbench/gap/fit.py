"""Fitting: one variant of an effect beside a model, and a model as a whole."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from hystbench.errors import InputError
from hystbench.gap.effects.base import Values, Variant
from hystbench.gap.reshape import orthonormal
from hystbench.gap.score import Score
from hystbench.gap.state import State, beside_columns, with_effect
from hystbench.record import FloatArray

HALVINGS = 2
"""Of the grid's step around its best value; least squares go on from there."""
GLANCE = 4
"""Records of which half is enough to choose a point of a grid."""
ROUNDS = 5
"""Of least squares in a refit."""
DAMPING = (0.0, 1e2, 1e4, 1e6)
"""Charge for a change of the whole of a number, tried until a step pays."""
ENOUGH = 0.05
"""A round that lowers the score by less is the last."""


@dataclass(frozen=True)
class Trial:
    """A variant with the values that score least.

    Parameters
    ----------
    variant : Variant
    values : dict of str to float
    score : float
        Of the model with the effect, what the model may re-tune re-tuned to first
        order.
    """

    variant: Variant
    values: dict[str, float]
    score: float


class Attempt:
    """One variant on one model, evaluated at values of its searched parameters."""

    def __init__(self, state: State, variant: Variant, score: Score) -> None:
        self.state, self.variant, self.score = state, variant, score
        self.freedom = state.freedom + variant.freedom
        self.known: dict[tuple[float, ...], Trial] = {}
        self.more = np.hstack([state.tangents, state.beside_columns])
        stiffness = np.zeros(self.more.shape[1])
        stiffness[: len(state.free)] = state.stiffness
        self.stiffness = stiffness
        self.zero: FloatArray | None = None

    def at(self, point: tuple[float, ...]) -> Trial:
        """Score the variant at a point of the grid."""
        if point not in self.known:
            self.known[point] = self._at(point)
        return self.known[point]

    def _at(self, point: tuple[float, ...]) -> Trial:
        variant, state = self.variant, self.state
        values = dict(zip(variant.grids, point, strict=True))
        residual = state.residual
        if variant.beside is not None:
            own = beside_columns(state, variant.beside, values)
        elif variant.unit:
            own, residual = self._scaled(values)
        else:
            take, tail = state.sample.take, state.scene.tail
            after = take(tail(variant.start, variant.build(values)))
            if variant.zero is None:
                residual = state.reference - after
            else:
                residual = state.residual - (after - self._at_zero(values))
            own = np.zeros((len(residual), 0))
        count = len(variant.unit)
        columns = np.hstack([own, self.more])
        stiffness = np.concatenate([np.zeros(own.shape[1]), self.stiffness])
        positive = [
            k for k, name in enumerate(variant.unit) if name in variant.positive
        ]
        found = self.score.amplitudes(
            residual, columns, self.freedom, stiffness, positive
        )
        amplitudes = found.values[:count]
        values |= {
            name: float(x) for name, x in zip(variant.unit, amplitudes, strict=True)
        }
        return Trial(variant, values, found.score)

    def _at_zero(self, values: Values) -> FloatArray:
        """Simulate the chain as before in the effect's own way; it is kept."""
        variant, state = self.variant, self.state
        if self.zero is None:
            at = {**values, **(variant.zero or {})}
            signals = state.scene.tail(variant.start, variant.build(at))
            self.zero = state.sample.take(signals)
        return self.zero

    def _scaled(self, values: Values) -> tuple[FloatArray, FloatArray]:
        """How the output changes with each parameter that is solved for."""
        variant, state = self.variant, self.state
        take, tail = state.sample.take, state.scene.tail
        zero = dict.fromkeys(variant.unit, 0.0)
        if variant.neutral:
            now = take(state.scene.output)
        else:
            now = take(tail(variant.start, variant.build({**values, **zero})))
        columns = []
        for name, step in variant.unit.items():
            given = {**values, **zero, name: step}
            after = take(tail(variant.start, variant.build(given)))
            columns.append((after - now) / step)
        own = np.column_stack(columns)
        anchored = variant.zero is not None
        return own, state.residual if anchored else state.reference - now


def coarse(attempt: Attempt, glance: Attempt | None = None) -> Trial:
    """Score a variant where it is best on its grid.

    Parameters
    ----------
    attempt : Attempt
    glance : Attempt, optional
        The same on fewer records, which then choose the point of the grid.
    """
    axes = attempt.variant.grids.values()
    look = attempt if glance is None or not axes else glance
    trials = []
    for point in itertools.product(*(axis.tolist() for axis in axes)):
        try:
            trials.append((look.at(tuple(point)).score, point))
        except InputError:
            continue  # values that the block itself refuses are no candidates
    return attempt.at(min(trials)[1])


@lru_cache(maxsize=1)
def at_a_glance(state: State, score: Score) -> tuple[State, Score]:
    """Give a model and its score on the half of the records with most of the gap."""
    slices = state.sample.slices
    if len(slices) < GLANCE:
        return state, score
    squares = [float(np.mean(state.residual[part] ** 2)) for part in slices]
    kept = sorted(np.argsort(squares, kind="stable")[len(squares) // 2 :].tolist())
    few = state.on(kept)
    directions = np.concatenate([score.directions[slices[k]] for k in kept])
    return few, Score(few.sample, orthonormal(directions), score.floor)


def fine(attempt: Attempt, start: Trial) -> Trial:
    """Halve the grid's step around its best point, one parameter at a time."""
    grids = attempt.variant.grids
    best = start
    steps = {
        name: np.log(axis[1] / axis[0]) if len(axis) > 1 else 0.0
        for name, axis in grids.items()
    }
    for _ in range(HALVINGS):
        steps = {name: step / 2 for name, step in steps.items()}
        for name, step in steps.items():
            for sign in (1, -1):
                here = {key: best.values[key] for key in grids}
                here[name] *= float(np.exp(sign * step))
                low, high = attempt.variant.ends(name)
                if not low <= here[name] <= high:
                    continue
                try:
                    trial = attempt.at(tuple(here.values()))
                except InputError:
                    continue
                if trial.score < best.score:
                    best = trial
                    break
    return best


def score_of(state: State, score: Score) -> float:
    """Score a model as it is; amplitudes of what lies beside are solved for."""
    return score.amplitudes(state.residual, state.beside_columns, state.freedom).score


def refit(state: State, score: Score, rounds: int = ROUNDS) -> tuple[State, float]:
    """Refit all free numbers together (Levenberg and Marquardt on the score).

    Returns
    -------
    state : State
        Never worse than the one given.
    score : float
    """
    best = score_of(state, score)
    for _ in range(rounds if state.free else 0):
        columns = np.hstack([state.tangents, state.beside_columns])
        count = len(state.free)
        size = sizes(state)
        before = best
        for damping in DAMPING:
            stiffness = np.zeros(columns.shape[1])
            stiffness[:count] = state.stiffness + damping / size**2
            found = score.amplitudes(
                state.residual, columns, state.freedom, stiffness
            ).values
            change = dict(enumerate(found[:count].tolist()))
            try:
                moved = state.with_chain(state.moved(change))
                value = score_of(moved, score)
            except InputError:
                continue  # out of what the blocks accept together: go less far
            if value < best:
                state, best = moved, value
                break
        if before - best < ENOUGH:
            break
    return state, best


def sizes(state: State) -> FloatArray:
    """Give the size of each free number: its value, or what moves the output a tenth.

    The second is for those that are zero, or nearly.
    """
    output = state.measured - state.residual
    moved = np.sqrt(np.mean(state.tangents**2, axis=0))
    tenth = 0.1 * np.sqrt(np.mean(output**2)) / np.maximum(moved, 1e-300)
    values = np.array([abs(state.value(free)) for free in state.free])
    return np.where(values > 1e-3 * tenth, values, np.minimum(tenth, 1e6))


def added(state: State, trial: Trial, score: Score) -> tuple[State, float]:
    """Add an effect as a trial found it and refit everything together."""
    after = with_effect(state, trial.variant, trial.values)
    if trial.variant.zero is not None:
        after = after.settled()
    return refit(after, score)


def finished(state: State, score: Score) -> tuple[State, float]:
    """Simulate a model exactly and refit it to the end."""
    state = state.settled()
    state, _ = refit(state, score)
    state = state.settled()
    return state, score_of(state, score)
