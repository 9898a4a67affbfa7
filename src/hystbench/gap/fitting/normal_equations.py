"""Normal equations of a few amplitudes, of which columns may say the same."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dpotrf, dpotrs

from hystbench.record import FloatArray

KNOWN = 1e-5
"""Least pivot of products of columns of size one that tell all of them apart."""


def solve(
    matrix: FloatArray, vector: FloatArray, positive: Sequence[int]
) -> FloatArray:
    """Solve normal equations; amplitudes that must not be negative are set to zero.

    Parameters
    ----------
    matrix : ndarray, shape (k, k)
        Symmetric, no eigenvalue negative.
    vector : ndarray, shape (k,)
    positive : sequence of int
        Places of those that may not be negative.

    Returns
    -------
    ndarray, shape (k,)
    """
    if not positive:
        return _solution(matrix, vector)
    active = np.ones(len(vector), dtype=bool)
    for _ in range(len(vector) + 1):
        beta: FloatArray = np.zeros(len(vector))
        if active.all():
            beta[:] = _solution(matrix, vector)
        elif active.any():
            keep = np.flatnonzero(active)
            beta[keep] = _solution(matrix[np.ix_(keep, keep)], vector[keep])
        negative = [k for k in positive if active[k] and beta[k] < 0]
        if not negative:
            return beta
        active[min(negative, key=lambda k: beta[k])] = False
    return beta


def _solution(matrix: FloatArray, vector: FloatArray) -> FloatArray:
    """Solve a symmetric system; directions that it hardly knows stay at zero.

    All of them do where a number is not finite, as where a model ran away.
    """
    if len(vector) == 1 and matrix[0, 0] > 0:  # as most are
        return np.asarray(vector / matrix[0])
    size = np.sqrt(np.maximum(matrix.diagonal(), 0.0))
    size[size == 0] = 1.0
    lower, failed = dpotrf(matrix, lower=1)
    if not failed and (lower.diagonal() > KNOWN * size).all():  # it is quicker
        return np.asarray(dpotrs(lower, vector, lower=1)[0])
    matrix, vector = matrix / (size[:, None] * size), vector / size
    if not (np.isfinite(matrix).all() and np.isfinite(vector).all()):
        return np.zeros(len(vector))
    return np.asarray(np.linalg.lstsq(matrix, vector, rcond=1e-13)[0] / size)


def joined(first: FloatArray, mixed: FloatArray, second: FloatArray) -> FloatArray:
    """Join products of two tables, shape (..., k, k); np.block takes far longer."""
    k, size = first.shape[-1], first.shape[-1] + second.shape[-1]
    out = np.empty((*first.shape[:-2], size, size))
    out[..., :k, :k], out[..., k:, k:] = first, second
    out[..., :k, k:], out[..., k:, :k] = mixed, mixed.mT
    return out


def column_rms(columns: FloatArray) -> FloatArray:
    """Give the root mean square of columns; one for those that are zero."""
    sizes = np.sqrt(np.einsum("ij,ij->j", columns, columns) / len(columns))
    return np.where(sizes > 0, sizes, 1.0)


def in_one_piece(part: NDArray[np.intp]) -> slice | NDArray[np.intp]:
    """Give a view's slice where samples stand in one piece, as they mostly do."""
    whole = part[-1] - part[0] + 1 == len(part)
    return slice(part[0], part[-1] + 1) if whole else part
