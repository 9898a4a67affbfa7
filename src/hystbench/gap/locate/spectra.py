"""Spectra of input, residual and simulation, of all records on one frequency axis."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hystbench.gap.compared import Compared
from hystbench.gap.locate.samples import Samples
from hystbench.gap.periods import settled
from hystbench.record import FloatArray

ComplexArray = NDArray[np.complex128]

U, R, S = range(3)
"""Input, residual and simulated output, as rows and columns of a spectral matrix."""
SEGMENTS = 4
"""Of a record without as many periods, that overlap by half."""
OVERLAP = 1 + 2 / 36
"""What the overlap takes from them: neighbours under a Hann window share a sixth
(Welch 1967)."""
HANN = 35 / 18
"""What a Hann window does to the variance of a sum over lines: n sum w^4 over the
square of sum w^2."""
BINS = 400
"""Of the common axis, evenly spaced in the logarithm of frequency."""
EXCITED = 1e-5
"""Of the strongest bin's input power, that an excited bin holds."""
FACTS = 3.0
"""Averages of a bin, at least: one alone is coherent with anything."""


@dataclass(frozen=True)
class Lines:
    """Spectral lines of one record, averaged over periods or segments.

    Parameters
    ----------
    frequency : ndarray, shape (m,)
        In Hz.
    matrix : ndarray of complex, shape (3, 3, m)
        Auto- and cross-spectra of input, residual and simulation: row times the
        conjugate of column. Sums over lines are mean squares.
    count : float
        Independent averages of a line.
    spread : float
        By what a window makes neighbours alike.
    samples : int
        Of the record.
    """

    frequency: FloatArray
    matrix: ComplexArray
    count: float
    spread: float
    samples: int


@dataclass(frozen=True)
class Spectra:
    """Spectra summed over the records in each bin, weighted by their lengths.

    Parameters
    ----------
    lines : tuple of Lines
    noise : float
        Variance of the noise floor.
    """

    lines: tuple[Lines, ...]
    noise: float

    @cached_property
    def edges(self) -> FloatArray:
        """Edges of the bins, in Hz."""
        low = min(float(one.frequency[0]) for one in self.lines)
        high = max(float(one.frequency[-1]) for one in self.lines)
        return np.geomspace(0.999 * low, 1.001 * high, BINS + 1)

    def gathered(
        self, of: Callable[[Lines], FloatArray], edges: FloatArray | None = None
    ) -> FloatArray:
        """Sum real values of lines in each bin, a mean over records by length."""
        ends = self.edges if edges is None else edges
        total = sum(one.samples for one in self.lines)
        found = np.zeros(len(ends) - 1)
        for one in self.lines:
            held, _ = np.histogram(one.frequency, ends, weights=of(one))
            found += one.samples / total * held
        return found

    @cached_property
    def matrix(self) -> ComplexArray:
        """Spectral matrix of each bin, shape (3, 3, bins)."""

        def of(row: int, column: int) -> ComplexArray:
            real = self.gathered(lambda one: one.matrix[row, column].real)
            return real + 1j * self.gathered(lambda one: one.matrix[row, column].imag)

        return np.array([[of(row, column) for column in range(3)] for row in range(3)])

    def power(self, row: int) -> FloatArray:
        """Mean square of a signal in each bin."""
        return self.matrix[row, row].real

    @cached_property
    def frequency(self) -> FloatArray:
        """Mean frequency of each bin that holds lines, NaN of others."""
        held = self.gathered(lambda one: np.ones_like(one.frequency))
        total = self.gathered(lambda one: one.frequency)
        return np.where(held > 0, total / np.maximum(held, 1e-300), np.nan)

    @cached_property
    def noise_power(self) -> FloatArray:
        """Mean square that the noise floor gives each bin."""
        return self.gathered(
            lambda one: np.full(len(one.frequency), self.noise / len(one.frequency))
        )

    @cached_property
    def count(self) -> FloatArray:
        """Independent facts of each bin: averages, and lines by the input's power."""
        held = self.gathered(lambda one: one.matrix[U, U].real)
        total = sum(one.samples for one in self.lines)
        square = self.gathered(
            lambda one: one.samples
            / total
            * one.matrix[U, U].real ** 2
            * (one.spread / one.count)
        )
        return held**2 / np.maximum(square, 1e-300)

    @cached_property
    def excited(self) -> NDArray[np.bool_]:
        """Bins in which the input has power, and averages enough to tell anything."""
        power = self.power(U)
        strong = power > EXCITED * float(np.max(power))
        return np.asarray(strong & (self.count >= FACTS))

    def coherence(self, a: int, b: int) -> FloatArray:
        """Coherence of two signals in each bin, from 0 to 1."""
        both = np.maximum(self.power(a) * self.power(b), 1e-300)
        return np.clip(np.abs(self.matrix[a, b]) ** 2 / both, 0.0, 1.0)


def take_spectra(samples: Samples) -> Spectra:
    """Average the spectra of each record by Welch's method."""
    return Spectra(tuple(map(_lines, samples.compared)), samples.noise)


def _lines(item: Compared) -> Lines:
    """Average over whole periods where there are enough, else over segments."""
    from scipy.signal import csd  # late: it takes long to load

    record = item.record
    signals = np.stack([record.u, item.residual, item.simulated])
    n, period = len(record), record.period_samples
    repeats = bool(period) and n >= SEGMENTS * (period or n)
    if repeats and period:
        runs = settled(signals, period)
        signals, count = runs.reshape(3, -1), float(runs.shape[1])
        about = {"window": "boxcar", "nperseg": period, "noverlap": 0}
    else:
        size = n // SEGMENTS
        count = (2 * SEGMENTS - 1) / OVERLAP
        about = {"window": "hann", "nperseg": size, "noverlap": size // 2}
    centred = signals - signals.mean(axis=1, keepdims=True)
    frequency, matrix = csd(
        centred[None], centred[:, None], 1 / record.dt, detrend=False, **about
    )
    step = float(frequency[1])
    spread = 1.0 if repeats else HANN
    return Lines(frequency[1:], matrix[..., 1:] * step, count, spread, n)
