"""Nonlinear least squares with a few unknowns between bounds."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from hystbench.record import FloatArray

STEPS = 40
"""Most steps of a descent."""
LEAST_GAIN = 1e-4
"""Share of the sum of squares; a descent ends when two steps in a row win less."""
TRIALS = 8
"""A step is damped so many times before a descent ends."""
_TINY = float(np.finfo(np.float64).tiny)


def damped_step(
    jacobian: FloatArray,
    error: FloatArray,
    point: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
    damping: float,
) -> FloatArray:
    """Take one step of Levenberg and Marquardt [1]_ within bounds.

    An unknown at a bound that the gradient pushes against is held; the others move
    as if there were no bounds and are then cut at them.

    Parameters
    ----------
    jacobian : ndarray, shape (n, p)
        Derivative of the error.
    error : ndarray, shape (n,)
        Error at the point.
    point, lower, upper : ndarray, shape (p,)
        Where to start, and the bounds.
    damping : float
        Share by which the diagonal of the normal equations is raised.

    Returns
    -------
    ndarray, shape (p,)
        The new point.

    References
    ----------
    .. [1] D. W. Marquardt, "An algorithm for least-squares estimation of nonlinear
       parameters", J. SIAM 11(2), 431-441, 1963, doi:10.1137/0111030.
    """
    gradient = jacobian.T @ error
    held = (point <= lower) & (gradient > 0)
    held |= (point >= upper) & (gradient < 0)
    free = np.flatnonzero(~held)
    normal = jacobian[:, free].T @ jacobian[:, free]
    raised = np.diag(normal) + 1e-12 * np.trace(normal) + _TINY
    move = np.zeros(len(point))
    move[free] = np.linalg.solve(normal + damping * np.diag(raised), -gradient[free])
    return np.clip(point + move, lower, upper)


@dataclass(frozen=True)
class LeastSquaresPoint:
    """A point and the error there."""

    point: FloatArray
    """Shape (p,)."""
    error: FloatArray
    """Shape (n,)."""

    @property
    def cost(self) -> float:
        """Sum of squares."""
        return float(self.error @ self.error)


AtPoint = TypeVar("AtPoint", bound=LeastSquaresPoint)


def descend(
    start: AtPoint,
    at: Callable[[FloatArray], AtPoint],
    slopes: Callable[[AtPoint], FloatArray],
    lower: FloatArray,
    upper: FloatArray,
    steps: int = STEPS,
    least_gain: float = LEAST_GAIN,
) -> Iterator[AtPoint]:
    """Go down a sum of squares, step by step.

    It ends after so many steps, when two in a row have each won less than the least
    gain, or with a step that wins nothing.

    Parameters
    ----------
    start : LeastSquaresPoint
        Where to start.
    at : callable
        Gives the error at a point, shape (p,).
    slopes : callable
        Gives the derivative of the error, shape (n, p).
    lower, upper : ndarray, shape (p,)
        Bounds of the point.
    steps : int
        Most steps.
    least_gain : float
        Share of the sum of squares.

    Yields
    ------
    LeastSquaresPoint
        Where each step leads; after a step that wins nothing, where it began.
    """
    now, damping, small_gains = start, 1e-2, 0
    for _ in range(steps):
        jacobian = slopes(now)
        for _ in range(TRIALS):
            point = damped_step(jacobian, now.error, now.point, lower, upper, damping)
            trial = at(point)
            if trial.cost < now.cost:
                break
            damping *= 5.0
        else:
            yield now
            return
        small = 1 - trial.cost / now.cost < least_gain
        small_gains = small_gains + 1 if small else 0
        now, damping = trial, max(damping * 0.2, 1e-9)
        yield now
        if small_gains == 2:
            return


def minimize(
    error: Callable[[FloatArray], FloatArray],
    point: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
) -> tuple[FloatArray, float]:
    """Go down a sum of squares from a point, with forward differences.

    Parameters
    ----------
    error : callable
        Error, shape (n,), at a point, shape (p,).
    point, lower, upper : ndarray, shape (p,)
        Where to start, and the bounds.

    Returns
    -------
    point : ndarray, shape (p,)
        The best point.
    cost : float
        Its sum of squares.
    """

    def at(point: FloatArray) -> LeastSquaresPoint:
        return LeastSquaresPoint(point, error(point))

    def slopes(now: LeastSquaresPoint) -> FloatArray:
        columns = []
        for k, value in enumerate(now.point):
            moved = now.point.copy()
            moved[k] += 1e-6 if value + 1e-6 <= upper[k] else -1e-6
            columns.append((error(moved) - now.error) / (moved[k] - value))
        return np.column_stack(columns)

    best = at(point)
    for step in descend(best, at, slopes, lower, upper):
        best = step
    return best.point, best.cost
