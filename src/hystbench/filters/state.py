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
    """What a filter carries from one chunk of a signal to the next."""

    weights: FloatArray
    """Weights after the last update."""
    past: FloatArray
    """The last inputs, oldest first, shape (history,)."""
    operators: FloatArray
    """Outputs of the play operators, by tap; empty for filters without."""
    largest: float = 0.0
    """Largest ``|d|`` so far."""
    diverged: bool = False
    """Whether it has; then it cannot go on."""


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
    """What an adaptive filter made of a record."""

    output: FloatArray
    error: FloatArray
    """Prediction y and a priori error ``e = d - y`` at each sample, shape (n,) each.
    They end before the sample at which the filter diverged."""
    weights: FloatArray
    """Weights after the last sample; after divergence of no use, but finite."""
    diverged_at: int | None
    """First sample whose error was beyond the limit or not a number."""
    state: State
    """State from which the next chunk goes on."""


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
