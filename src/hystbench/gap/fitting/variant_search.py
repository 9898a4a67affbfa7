"""Searching one variant of an effect beside a model: a grid, then Gauss and Newton."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial
from math import prod
from typing import NamedTuple

import numpy as np

from hystbench.blocks.calls import CallsUsedUp
from hystbench.blocks.parameter import HUGE
from hystbench.cores import each
from hystbench.errors import InputError
from hystbench.gap.effects.effect import Declined
from hystbench.gap.effects.variant import Values, Variant
from hystbench.gap.fitting.added_signals import beside_columns
from hystbench.gap.fitting.held import Held
from hystbench.gap.fitting.score import Amplitudes, Score, Shared
from hystbench.gap.fitting.serialize import remembered_of
from hystbench.gap.fitting.state import ModelState
from hystbench.record import FloatArray

HALVINGS = 4
"""Halvings of a grid's step, where several numbers are searched; one for a single
number."""
NEWTON = 3
"""Steps of Gauss and Newton from a grid's best value, at most."""

NUDGE = 1e-3
"""Relative change by which they are found."""

LAST_STEP = 3.0
"""Least gain of a step of the search: one that lowers the score by less is the last."""

POINTS_EACH = 15
"""Points of a grid for each of which one more is looked at on all records."""

Point = tuple[float, ...]
"""Values of the searched parameters."""


@dataclass(frozen=True)
class Trial:
    """A variant beside a model, with values of its numbers."""

    attempt: Attempt
    values: dict[str, float]
    score: float
    """Score of the model with the effect, what may be re-tuned being re-tuned to first
    order."""

    @property
    def variant(self) -> Variant:
        """The variant that is tried."""
        return self.attempt.variant


class LeastPoint(NamedTuple):
    """What was simulated at the point that scores least: a step begins there."""

    point: Point
    score: float
    own: FloatArray
    residual: FloatArray
    amplitudes: FloatArray


class Attempt:
    """One variant on one model, evaluated at values of its searched parameters.

    Its number is its place among all that the effect offers.
    """

    def __init__(
        self, state: ModelState, variant: Variant, score: Score, number: int = 0
    ) -> None:
        self.state, self.variant, self.score = state, variant, score
        self.number = number
        self.freedom = state.freedom + variant.freedom
        self.known: dict[Point, Trial] = {}
        self.zero: FloatArray | None = None
        self.least: LeastPoint | None = None

    @cached_property
    def power(self) -> float:
        """Mean square of the measured output about its mean."""
        return max(float(np.var(self.state.measured)), 1.0 / HUGE)

    def at(self, point: Point) -> Trial:
        """Score the variant at a point of the grid."""
        if point not in self.known:
            self.known[point] = self._at(point)
        return self.known[point]

    def _at(self, point: Point) -> Trial:
        own, residual = self._signals(point)
        found = self._solve(residual, own)
        if self.least is None or found.score < self.least.score:
            amplitudes = found.values[: own.shape[1]]
            self.least = LeastPoint(point, found.score, own, residual, amplitudes)
        variant = self.variant
        values = dict(zip(variant.grids, point, strict=True))
        scaled = found.values[: len(variant.unit)]
        values |= {name: float(x) for name, x in zip(variant.unit, scaled, strict=True)}
        return Trial(self, values, found.score)

    def step(self, trial: Trial) -> FloatArray:
        """Give the step of Gauss and Newton from a trial, in logarithms.

        Returns
        -------
        ndarray, shape (searched parameters,)

        Raises
        ------
        InputError
            If the block refuses values beside those of the trial.
        """
        point = tuple(trial.values[name] for name in self.variant.grids)
        if self.least is not None and self.least.point == point:
            own, residual, amplitudes = self.least[2:]
        else:
            own, residual = self._signals(point)
            amplitudes = self._solve(residual, own).values[: own.shape[1]]
        now = residual - own @ amplitudes
        moved = []
        for k in range(len(point)):
            beside = list(point)
            beside[k] *= float(np.exp(NUDGE))
            own_there, there = self._signals(tuple(beside))
            moved.append((now - (there - own_there @ amplitudes)) / NUDGE)
        columns = np.column_stack([*moved, own])
        return self._solve(residual, columns, len(moved)).values[: len(moved)]

    def _solve(
        self, residual: FloatArray, columns: FloatArray, first: int = 0
    ) -> Amplitudes:
        """Solve for the amplitudes of columns and what the model may re-tune.

        An amplitude that alone moves the output by its own rms costs a point: where a
        number of the base does the same as one of the effect, the two must not run away
        against each other.
        """
        variant = self.variant
        charge = np.mean(columns**2, axis=0) / self.power
        charge[:first] = 0.0
        positive = [
            first + k for k, name in enumerate(variant.unit) if name in variant.positive
        ]
        return self.score.amplitudes(
            residual,
            columns,
            self.freedom,
            Held.here(charge),
            positive,
            _retuned(self.state, self.score),
        )

    def _signals(self, point: Point) -> tuple[FloatArray, FloatArray]:
        """Simulate the variant at a point of its grid.

        Returns
        -------
        own : ndarray, shape (scored samples, k)
            What is solved for: how the output changes with each amplitude.
        residual : ndarray, shape (scored samples,)
            With all amplitudes zero.
        """
        variant, state = self.variant, self.state
        values = dict(zip(variant.grids, point, strict=True))
        if variant.beside is not None:
            return beside_columns(
                state.records, state.sample, variant.beside, values
            ), state.residual
        if variant.unit:
            return self._scaled(values)
        after = state.sample.take(
            state.simulation.tail(variant.start, variant.build(values))
        )
        if variant.zero is None:
            residual = state.reference - after
        else:
            residual = state.residual - (after - self._at_zero(values))
        return np.zeros((len(residual), 0)), residual

    def _at_zero(self, values: Values) -> FloatArray:
        """Simulate the chain as before in the effect's own way; it is kept."""
        variant, state = self.variant, self.state
        if self.zero is None:
            at = {**values, **(variant.zero or {})}
            signals = state.simulation.tail(variant.start, variant.build(at))
            self.zero = state.sample.take(signals)
        return self.zero

    def _scaled(self, values: Values) -> tuple[FloatArray, FloatArray]:
        """How the output changes with each parameter that is solved for."""
        variant, state = self.variant, self.state
        take, tail = state.sample.take, state.simulation.tail
        zero = dict.fromkeys(variant.unit, 0.0)
        if variant.neutral:
            now = take(state.simulation.output)
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


@lru_cache(maxsize=3)
def _retuned(state: ModelState, score: Score) -> Shared:
    """Prepare what a model may re-tune, which all its attempts share."""
    columns = np.hstack([state.tangents, state.beside_columns])
    return score.shared(columns, state.held.padded(columns.shape[1]))


def best_points(look: Attempt) -> list[tuple[float, Point]]:
    """Give the points of a grid that score least, with their scores, best first.

    Of a grid of two axes with three points or more the long axis is swept at the middle
    of the short one, and the valley that is found there is followed to both sides: a
    line next to it has its own a step or two away. Any other grid is tried whole, and
    so is one that shows nothing on its middle line.

    Raises
    ------
    Declined
        If the blocks refuse every point of the grid: with what the last one said.
    """
    axes = [axis.tolist() for axis in look.variant.grids.values()]
    grid = _Grid(look, axes)
    sizes = sorted(map(len, axes))
    walked = len(sizes) == 2 and sizes[0] > 2
    if not (walked and grid.follow_valley(0 if len(axes[0]) >= len(axes[1]) else 1)):
        for place in itertools.product(*(range(len(axis)) for axis in axes)):
            grid.at(place)
    if not grid.scores:
        raise Declined(str(grid.refused)) from grid.refused
    best = sorted((score, point) for point, score in grid.scores.items())
    return best[: 1 + prod(sizes) // POINTS_EACH]


class _Grid:
    """Points of a grid that were scored."""

    def __init__(self, look: Attempt, axes: Sequence[Sequence[float]]) -> None:
        self.look, self.axes = look, axes
        self.scores: dict[Point, float] = {}
        self.refused: InputError | None = None
        """What the blocks said of the last point that they refuse."""

    def at(self, place: Sequence[int]) -> float:
        """Score one point; infinite where the blocks refuse its values."""
        point = tuple(axis[k] for axis, k in zip(self.axes, place, strict=True))
        try:
            self.scores[point] = self.look.at(point).score
        except CallsUsedUp as error:  # half a grid may miss what is best
            raise Declined(str(error)) from error
        except InputError as error:
            self.refused = error
            return np.inf
        return self.scores[point]

    def follow_valley(self, along: int) -> bool:
        """Sweep one of two axes whole, and walk from line to line of the other.

        Returns
        -------
        bool
            Whether there was a valley to follow.
        """
        size, lines = len(self.axes[along]), len(self.axes[1 - along])

        def at(k: int, line: int) -> float:
            return self.at((k, line) if along == 0 else (line, k))

        middle = lines // 2
        scores = [at(k, middle) for k in range(size)]
        first = int(np.argmin(scores))
        if not np.isfinite(scores[first]):
            return False
        for side in (range(middle + 1, lines), range(middle - 1, -1, -1)):
            lowest = first
            for line in side:
                lowest = _walked(partial(at, line=line), lowest, size)
        return True


def _walked(score: Callable[[int], float], start: int, size: int) -> int:
    """Give where a line is lowest, walking from a place for as long as it falls."""
    best, least = start, score(start)
    if not np.isfinite(least):  # nothing to walk along
        best = min(range(size), key=score)
        return best if np.isfinite(score(best)) else start
    for step in (1, -1):
        while 0 <= best + step < size and (there := score(best + step)) < least:
            best, least = best + step, there
    return best


def best_of(attempt: Attempt, points: Sequence[Point]) -> Trial:
    """Score a variant at the best of some points.

    Raises
    ------
    Declined
        If the blocks refuse all of them: with what the last one said.
    """
    found = []
    refused: InputError | None = None
    for point in points:
        try:
            found.append(attempt.at(point))
        except InputError as error:
            refused = error
    if not found:
        raise Declined(str(refused)) from refused
    return min(found, key=lambda trial: trial.score)


def fine(start: Trial) -> Trial:
    """Search around the best point of a grid: halve its step, then Gauss and Newton.

    The halved steps are tried one parameter at a time.
    """
    attempt = start.attempt
    about = "fine", start.variant.effect, attempt.number, start.values
    found = remembered_of(
        attempt.state,
        lambda: [*about, attempt.score.digest],
        lambda: _fine(start),
    )
    return Trial(attempt, *found)


def fine_each(starts: Sequence[Trial]) -> list[Trial]:
    """Search around the best point of each of several grids."""

    def found(start: Trial) -> tuple[dict[str, float], float]:
        trial = fine(start)
        return trial.values, trial.score

    searched = each(found, starts, "fine search")
    return [Trial(x.attempt, *own) for x, own in zip(starts, searched, strict=True)]


def _fine(start: Trial) -> tuple[dict[str, float], float]:
    """Give the values that score least, and the score."""
    grids = start.variant.grids
    best = start
    steps = {
        name: np.log(axis[1] / axis[0]) if len(axis) > 1 else 0.0
        for name, axis in grids.items()
    }
    for halved in range(HALVINGS if len(grids) > 1 else 1):
        for name, step in steps.items():
            for sign in (1, -1):
                trial = _beside(best, {name: sign * step / 2 ** (halved + 1)})
                if trial is not None and trial.score < best.score:
                    best = trial
                    break
    most = np.abs(list(steps.values())) / 2  # of a grid of negative values too
    for _ in range(NEWTON if grids else 0):
        try:
            step = np.clip(start.attempt.step(best), -most, most)
        except InputError:
            break  # at an end of what the block accepts
        before = best.score
        for share in (1.0, 0.3):
            trial = _beside(best, dict(zip(grids, share * step, strict=True)))
            if trial is not None and trial.score < best.score:
                best = trial
                break
        if before - best.score < LAST_STEP:
            break
    return best.values, best.score


def _beside(trial: Trial, steps: dict[str, float]) -> Trial | None:
    """Score a variant some steps away, in logarithms, inside its ranges."""
    here = {name: trial.values[name] for name in trial.variant.grids}
    for name, step in steps.items():
        low, high = trial.variant.ends(name)
        here[name] = float(np.clip(here[name] * np.exp(step), low, high))
    try:
        return trial.attempt.at(tuple(here.values()))
    except InputError:
        return None  # values that the block itself refuses are no candidates
