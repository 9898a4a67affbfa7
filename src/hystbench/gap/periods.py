"""The periods of a record that repeats."""

from __future__ import annotations

from hystbench.record import FloatArray


def settled(values: FloatArray, period: int) -> FloatArray:
    """Give the whole periods at the end of signals, one behind the other.

    The first of them holds the way from rest: it is left out, given two others.

    Parameters
    ----------
    values : ndarray, shape (..., n)
    period : int
        Samples of a period, at most n.

    Returns
    -------
    ndarray, shape (..., periods, period)
    """
    count = values.shape[-1] // period
    used = count - 1 if count > 2 else count
    return values[..., -used * period :].reshape(*values.shape[:-1], used, period)
