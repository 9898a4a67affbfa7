"""A record beside its simulation: what every view and picture of the gap reads."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hystbench.gap.records.sample import without
from hystbench.record import FloatArray, Record


@dataclass(frozen=True)
class Compared:
    """A record and what a model says of it, in free run from the input alone.

    Parameters
    ----------
    record : Record
    simulated : ndarray, shape (n,)
        In the unit of the record's output.
    """

    record: Record
    simulated: FloatArray

    @property
    def residual(self) -> FloatArray:
        """Measured minus simulated, shape (n,).

        Without what an unknown velocity at the first sample does.
        """
        return without(self.record.y - self.simulated, self.record.of_start)


def rms(values: FloatArray) -> float:
    """Give the root of the mean square."""
    return float(np.sqrt(np.mean(np.square(values))))


def whole_periods(values: FloatArray, period: int) -> FloatArray:
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
