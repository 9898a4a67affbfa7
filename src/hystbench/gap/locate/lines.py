"""Spectral lines of a record, for the fit of a mode."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from hystbench.gap.records.residual import Compared, whole_periods
from hystbench.record import FloatArray

ComplexArray = NDArray[np.complex128]

EXCITED = 1e-3
"""Of the strongest line's input power, that an excited line holds."""
ENOUGH = 2**15
"""Samples of a record without periods that are looked at, from its end on."""


class Lines(NamedTuple):
    """Spectral lines of one record.

    Parameters
    ----------
    frequency : ndarray, shape (m,)
        In Hz.
    u, y, missed : ndarray of complex, shape (m,)
        Input, output and what the simulation misses of it. The sum of ``|y|^2`` is the
        mean square about the mean.
    ends : bool
        Whether the record's ends leave a transient in the lines.
    """

    frequency: FloatArray
    u: ComplexArray
    y: ComplexArray
    missed: ComplexArray
    ends: bool

    def within(self, chosen: NDArray[np.bool_]) -> Lines:
        """Give some of the lines."""
        return Lines(
            self.frequency[chosen],
            self.u[chosen],
            self.y[chosen],
            self.missed[chosen],
            self.ends,
        )

    @property
    def excited(self) -> NDArray[np.bool_]:
        """Lines that the input excites."""
        power = np.abs(self.u) ** 2
        return np.asarray(power > EXCITED * float(np.max(power, initial=0.0)))


def lines_of(compared: Compared) -> Lines:
    """Transform a record: its settled periods, or its end where none repeat."""
    record = compared.record
    period = record.period_samples
    signals = np.stack([record.u, record.y, compared.residual])
    repeats = period is not None and len(record) >= 2 * period
    if period is not None and repeats:
        runs = whole_periods(signals, period)
        # Of two periods the first still holds the way from rest.
        signals = runs[:, -1] if runs.shape[1] == 2 else runs.mean(axis=1)
    else:
        signals = signals[:, -ENOUGH:]
    n = signals.shape[1]
    centred = signals - signals.mean(axis=1, keepdims=True)
    u, y, missed = np.asarray(fft.rfft(centred))[:, 1:] * (np.sqrt(2) / n)
    frequency = np.asarray(fft.rfftfreq(n, record.dt))[1:]
    return Lines(frequency, u, y, missed, not repeats)
