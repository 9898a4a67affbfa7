"""Values between the points of a table."""

import numpy as np
from numpy.typing import NDArray

from hystbench.record import FloatArray


def cubic(values: FloatArray, k: NDArray[np.int64], p: FloatArray) -> FloatArray:
    """Read at ``k + p`` by the cubic of Catmull and Rom through the four around.

    Parameters
    ----------
    values : ndarray, shape (m,)
    k : ndarray of int, shape (n,)
        From 1 to m - 3.
    p : ndarray, shape (n,)
        From 0 to 1.
    """
    before, here, after, second = (values[k + i] for i in (-1, 0, 1, 2))
    return np.asarray(
        here
        + 0.5 * p * (after - before)
        + p**2 * (before - 2.5 * here + 2.0 * after - 0.5 * second)
        + 0.5 * p**3 * (second - before + 3.0 * (here - after))
    )
