"""What a filter carries and gives, and the checks of what it is given."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from hystbench import kernels
from hystbench.errors import InputError
from hystbench.record import FloatArray


@dataclass(frozen=True)
class State:
    """What a filter carries from one chunk of a signal to the next.

    Parameters
    ----------
    weights : ndarray
        Weights after the last update.
    past : ndarray, shape (history,)
        The last inputs, oldest first: as many as the filter looks back on.
    operators : ndarray
        Outputs of the play operators, by tap; empty for filters without.
    limit : float or None
        Error beyond which the filter has diverged; None for a million times
        ``largest``.
    largest : float
        Largest ``|d|`` so far.
    diverged : bool
        Whether it has; then it cannot go on.
    """

    weights: FloatArray
    past: FloatArray
    operators: FloatArray
    limit: float | None = None
    largest: float = 0.0
    diverged: bool = False


End = tuple[FloatArray, FloatArray]
"""Weights and outputs of the operators after a chunk."""


class Chunk(NamedTuple):
    """A part of a record that is filtered at a time."""

    line: FloatArray
    """Past inputs, as many as the filter looks back on, then those of the chunk."""
    d: FloatArray
    """Output of the plant."""
    limit: float
    """Magnitude of the error beyond which a filter has diverged."""


@dataclass(frozen=True)
class Result:
    """What an adaptive filter made of a record.

    Parameters
    ----------
    output, error : ndarray, shape (n,)
        Prediction y and a priori error ``e = d - y`` at each sample. They end before
        the sample at which the filter diverged.
    weights : ndarray
        Weights after the last sample; after divergence of no use, but finite.
    diverged_at : int or None
        First sample whose error was beyond the limit or not a number.
    state : State
        Where to go on with the next chunk.
    """

    output: FloatArray
    error: FloatArray
    weights: FloatArray
    diverged_at: int | None
    state: State


def positive(name: str, value: float) -> None:
    """Refuse a parameter that is not a positive finite number."""
    if not 0 < value < np.inf:
        raise InputError(f"{name}: {value} given, a positive number expected")


def finite(name: str, values: ArrayLike) -> tuple[FloatArray, float]:
    """Give a vector of finite numbers, as the kernels want it, and the largest."""
    array = np.asarray(values, dtype=np.float64, order="C")
    if array.ndim != 1:
        raise InputError(f"{name}: {array.ndim} dimensions given, 1 expected")
    largest = kernels.largest(array)
    if not math.isfinite(largest):
        place = int(np.flatnonzero(~np.isfinite(array))[0])
        raise InputError(f"{name}: sample {place} is {array[place]}")
    return array, largest
