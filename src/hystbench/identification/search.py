"""The search of Algorithm 1: down J from many starting points, the best kept."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import cast

import numpy as np

from hystbench.bounded_least_squares import (
    LEAST_GAIN,
    STEPS,
    LeastSquaresPoint,
    descend,
)
from hystbench.envelope import Envelope, thresholds
from hystbench.identification import shape
from hystbench.identification.weights import Samples, Start, lead_in, reduced, solve
from hystbench.record import FloatArray

Progress = Callable[[int, float], None]

TINY = float(np.finfo(np.float64).tiny)


@dataclass(frozen=True)
class FeasiblePoint:
    """A feasible point and its J over the whole record."""

    point: FloatArray
    start: Start
    cost: float


@dataclass(frozen=True)
class _Fit(LeastSquaresPoint):
    """A point with its best weights on the samples of a search."""

    outputs: FloatArray
    weights: FloatArray


class Search:
    """Steps 4 to 7 from any number of starting points, and the best they found.

    Parameters
    ----------
    record : Samples
        The whole slow record; its lead is set anew for each descent.
    order : int
        Order N.
    epsilon : float
        Tolerable J over the whole record.
    max_iterations : int
        Iterations in all.
    progress : callable, optional
        Called with the iteration and the least J after each iteration.
    """

    def __init__(
        self,
        record: Samples,
        order: int,
        epsilon: float,
        max_iterations: int,
        progress: Progress | None = None,
    ) -> None:
        self.record, self.order, self.epsilon = record, order, epsilon
        self.low, self.high = float(record.u.min()), float(record.u.max())
        self.amplitude = max(abs(self.low), abs(self.high))
        self.max_iterations, self.progress = max_iterations, progress
        self.history: list[float] = []
        self.best = FeasiblePoint(np.zeros(0), "rest", np.inf)
        """The point of least J so far; no point before the first descent."""

    @property
    def ended(self) -> bool:
        """Whether epsilon is reached or the iterations are used up."""
        reached = self.best.cost < self.epsilon
        return reached or len(self.history) >= self.max_iterations

    def descend(
        self,
        point: FloatArray,
        start: Start,
        count: int,
        steps: int = STEPS,
        least_gain: float = LEAST_GAIN,
    ) -> None:
        """Go down J from a point, on the record thinned to ``count`` samples.

        It ends after so many steps, or when two in a row have each won less than
        the least gain, a share of J.
        """
        samples = self._thinned(start, count)
        fit = self._fit(samples, point)
        self._offer(fit, samples, start)
        self._note()
        at, slopes = partial(self._fit, samples), partial(self._jacobian, samples)
        ends = shape.LOWER, shape.UPPER
        descent = descend(fit, at, slopes, *ends, steps, least_gain)
        while not self.ended and (step := next(descent, None)) is not None:
            if step is not fit:
                fit = step
                self._offer(fit, samples, start)
            self._note()

    def envelope(self, point: FloatArray) -> tuple[Envelope, FloatArray]:
        """Build envelopes and thresholds, Step 4."""
        envelope = shape.envelope_of(point, self.low, self.high)
        return envelope, thresholds(envelope, self.amplitude, self.order)

    def _note(self) -> None:
        self.history.append(self.best.cost)
        if self.progress is not None:
            self.progress(len(self.history), self.best.cost)

    def _thinned(self, start: Start, count: int) -> Samples:
        u, y = reduced(self.record.u, self.record.y, count)
        return replace(self.record, u=u, y=y, lead=lead_in(self.record.u, start))

    def _fit(self, samples: Samples, point: FloatArray) -> _Fit:
        """Steps 5 and 6 for given envelopes: outputs, best weights, error."""
        outputs = samples.outputs(*self.envelope(point))
        weights, constant = solve(
            outputs, samples.y, samples.with_offset, samples.nonnegative
        )
        return _Fit(point, outputs @ weights + constant - samples.y, outputs, weights)

    def _jacobian(self, samples: Samples, fit: _Fit) -> FloatArray:
        """Derivative of the error along each coordinate, weights following.

        Kaufman's form: differences at fixed weights, less what the weights that
        are not at zero take up.
        """
        columns = []
        before = fit.outputs @ fit.weights
        for k in range(len(fit.point)):
            move = 1e-6 if fit.point[k] + 1e-6 <= shape.UPPER[k] else -1e-6
            moved = fit.point.copy()
            moved[k] += move
            after = samples.model(*self.envelope(moved), fit.weights)
            columns.append((after - before) / move)
        jacobian = np.column_stack(columns)
        active = fit.outputs[:, fit.weights != 0]
        if samples.with_offset:
            active = np.column_stack([active, np.ones(len(active))])
        active = active / np.maximum(np.linalg.norm(active, axis=0), TINY)
        normal = active.T @ active + 1e-13 * np.eye(active.shape[1])
        taken = np.linalg.solve(normal, active.T @ jacobian)
        return cast(FloatArray, jacobian - active @ taken)

    def _offer(self, fit: _Fit, samples: Samples, start: Start) -> None:
        """Keep a point if its J over the whole record is the least, Step 7."""
        whole, thinned = len(self.record.u), len(samples.u)
        # the thinned record tells enough of points that are clearly worse
        if fit.cost / thinned > 1.2 * self.best.cost / whole:
            return
        if thinned < whole:
            fit = self._fit(replace(self.record, lead=samples.lead), fit.point)
        if fit.cost < self.best.cost:
            self.best = FeasiblePoint(fit.point, start, fit.cost)
