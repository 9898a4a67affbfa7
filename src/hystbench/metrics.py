"""How far a model's output lies from the plant's."""

import numpy as np
from numpy.typing import ArrayLike

from hystbench.errors import InputError
from hystbench.record import FloatArray


def rms(*signals: FloatArray) -> float:
    """Root of the mean square of a signal, or of all samples of several together."""
    return float(np.sqrt(np.mean(np.square(np.concatenate(signals)))))


def mean_square_error(e: ArrayLike) -> float:
    """Mean square error, the MSE of the paper's Tables 1 to 4.

    Parameters
    ----------
    e : array_like, shape (n,)
        Error at each sample.

    Returns
    -------
    float
        ``mean(e^2)``, in the square of the error's unit.
    """
    return float(np.mean(_some("e", e) ** 2))


def relative_error(e: ArrayLike, d: ArrayLike) -> float:
    """Relative error, the RE of the paper's Tables 1 to 4.

    The paper does not define it; its printed pairs of MSE and RE are consistent with
    this form.

    Parameters
    ----------
    e, d : array_like, shape (n,)
        Error and plant output at each sample.

    Returns
    -------
    float
        ``sqrt(sum(e^2) / sum(d^2))``, without unit.

    Raises
    ------
    InputError
        If lengths differ or d is zero throughout.
    """
    error, reference = _some("e", e), _some("d", d)
    if len(error) != len(reference):
        raise InputError(f"d: {len(reference)} samples given, e has {len(error)}")
    power = float(np.sum(reference**2))
    if power == 0:
        raise InputError("d: zero throughout, so there is no error relative to it")
    return float(np.sqrt(np.sum(error**2) / power))


def smoothed_squared_error(e: ArrayLike, window: int) -> FloatArray:
    """Moving mean of the squared error: the learning curve of an adaptive filter.

    Parameters
    ----------
    e : array_like, shape (n,)
        Error at each sample.
    window : int
        Samples in a mean, from 1 to n.

    Returns
    -------
    ndarray, shape (n - window + 1,)
        Entry k is the mean of ``e^2`` over samples k to k + window - 1.

    Raises
    ------
    InputError
        If the window does not fit.
    """
    squares = _some("e", e) ** 2
    if not 1 <= window <= len(squares):
        raise InputError(f"window: {window} given, 1 to {len(squares)} expected")
    # A window is the end of one block of its length and the start of the next: both
    # sums are had for all windows at once, and no sum is taken from a larger one.
    count = len(squares) - window + 1
    blocks = np.zeros((-(-len(squares) // window), window))
    blocks.ravel()[: len(squares)] = squares
    ends = blocks[:, ::-1].cumsum(axis=1)[:, ::-1].ravel()[:count]
    starts = blocks.cumsum(axis=1).ravel()[window - 1 : window - 1 + count]
    starts[::window] = 0.0  # where the end is the whole block
    return np.asarray((ends + starts) / window)


def _some(name: str, values: ArrayLike) -> FloatArray:
    array = np.asarray(values, dtype=np.float64)
    if array.ndim != 1 or len(array) == 0:
        raise InputError(f"{name}: {array.shape} given, at least one sample expected")
    return array
