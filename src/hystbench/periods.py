"""Whether an input repeats itself, and after how many samples."""

import numpy as np
from scipy import fft

from hystbench.record import FloatArray

AS_GOOD = 4.0
"""A shorter period is taken whose mean square difference is larger by up to this."""
EXACT = 1e-8
"""A mean square difference, of the variance, below which two periods are the same."""
ALIKE = 0.1
"""Of the standard deviation: periods that differ by more, rms, are not the same."""
RISEN = 0.5
"""Half of the variance: within a period an input differs from itself by more."""


def find_period(u: FloatArray) -> int | None:
    """Find the shortest period of an input, in samples.

    With ``d(k)`` half the mean square of ``u[t + k] - u[t]`` over the variance of
    ``u``, a period is a minimum of ``d`` behind a maximum of at least ``RISEN``: of a
    signal that repeats itself the mean of ``d`` over a period is one. It must lie
    twice in the record, and two periods may differ by ``ALIKE``. Where no whole number
    of samples is a period, a multiple of it that is nearer to one is found.

    Parameters
    ----------
    u : ndarray, shape (n,)

    Returns
    -------
    int or None
        None where the input does not repeat itself.
    """
    apart = differences(u)
    # Behind the first rise: a slow signal differs little from one sample to the next.
    risen = np.flatnonzero(apart >= RISEN)
    if not len(risen):
        return None
    first = int(risen[0])
    least = float(apart[first:].min())
    limit = min(max(AS_GOOD * least, EXACT), ALIKE**2 / 2)
    good = first + np.flatnonzero(apart[first:] <= limit)
    if not len(good):
        return None
    # The run of lags about the first minimum.
    end = int(np.argmax(np.append(np.diff(good) > 1, True)))
    run = good[: end + 1]
    return int(run[np.argmin(apart[run])])


def differences(u: FloatArray) -> FloatArray:
    """Give ``d(k)`` for all lags up to half the record, shape (n // 2 + 1,)."""
    n = len(u)
    x = u - np.mean(u)
    variance = float(np.mean(x**2))
    if not variance > 0 or n < 4:
        return np.zeros(1)
    size = fft.next_fast_len(2 * n, real=True)
    spectrum = fft.rfft(x, size)
    products = fft.irfft(np.abs(spectrum) ** 2, size)[: n // 2 + 1]
    squares = np.concatenate([[0.0], np.cumsum(x**2)])
    lags = np.arange(n // 2 + 1)
    both = squares[n - lags] + squares[n] - squares[lags]
    apart = (both - 2 * products) / (2 * (n - lags) * variance)
    return np.asarray(np.maximum(apart, 0.0), dtype=np.float64)
