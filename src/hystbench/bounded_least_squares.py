"""Nonlinear least squares with a few unknowns between bounds."""

from collections.abc import Callable

import numpy as np

from hystbench.record import FloatArray

STEPS = 40
"""Most steps of a descent."""
LEAST_GAIN = 1e-4
"""Share of the sum of squares; a descent ends when two steps in a row win less."""
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
    now = error(point)
    damping, small_gains = 1e-2, 0
    for _ in range(STEPS):
        columns = []
        for k in range(len(point)):
            moved = point.copy()
            moved[k] += 1e-6 if point[k] + 1e-6 <= upper[k] else -1e-6
            columns.append((error(moved) - now) / (moved[k] - point[k]))
        jacobian = np.column_stack(columns)
        cost = float(now @ now)
        for _ in range(8):
            trial = damped_step(jacobian, now, point, lower, upper, damping)
            after = error(trial)
            if after @ after < cost:
                break
            damping *= 5.0
        else:
            break
        point, now, damping = trial, after, max(damping * 0.2, 1e-9)
        small = float(after @ after) > (1 - LEAST_GAIN) * cost
        small_gains = small_gains + 1 if small else 0
        if small_gains == 2:
            break
    return point, float(now @ now)
