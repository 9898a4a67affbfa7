"""MINPACK's least squares, the same to the last digit from run to run.

SciPy 1.17's port reads, where it measures a column of the derivatives anew, one number
behind its end: of the last column what happens to lie there in memory. Long fits of
numbers that the records hardly tell apart ended elsewhere for that. So a number more is
fitted, which nothing depends on: its column is the shortest, so it comes last, and is
never measured anew.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hystbench.record import FloatArray

GUARD = 1e-100
"""Derivative of that number, in a row of its own: less than any other column."""


def least_squares_point(
    residual: Callable[[FloatArray], FloatArray],
    slopes: Callable[[FloatArray], FloatArray],
    count: int,
    *,
    scale: float,
    evaluations: int,
    enough: float,
) -> FloatArray:
    """Find where a sum of squares is least, from zero, by Levenberg and Marquardt.

    Parameters
    ----------
    residual : callable
        Gives the residual at a point, shape (rows,).
    slopes : callable
        Gives its derivatives, shape (rows, count).
    count : int
        Numbers of a point.
    scale : float
        Inverse of a large change, of all numbers alike.
    evaluations : int
        Most evaluations of the residual.
    enough : float
        Share by which the squares, or the numbers, have to change for another step.

    Returns
    -------
    ndarray, shape (count,)

    References
    ----------
    .. [1] J. J. More, "The Levenberg-Marquardt algorithm: implementation and theory",
       Numerical Analysis, Lecture Notes in Mathematics 630, 1978, 105-116.
    """
    from scipy.optimize import leastsq  # late: a start alone needs none of it

    def guarded_residual(point: FloatArray) -> FloatArray:
        return np.append(residual(point[:-1]), GUARD * point[-1])

    def guarded_slopes(point: FloatArray) -> FloatArray:
        own = slopes(point[:-1])
        whole = np.zeros((len(own) + 1, count + 1))
        whole[:-1, :-1] = own
        whole[-1, -1] = GUARD
        return whole

    point, *_ = leastsq(
        guarded_residual,
        np.zeros(count + 1),
        Dfun=guarded_slopes,
        full_output=True,
        maxfev=evaluations,
        xtol=enough,
        ftol=enough,
        diag=np.full(count + 1, scale),
    )
    return np.asarray(point[:-1])
