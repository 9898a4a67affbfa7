"""Spectra of input, residual and simulation, of all records on one frequency axis."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hystbench.gap.locate.samples import ViewSamples
from hystbench.gap.records.residual import Compared, whole_periods
from hystbench.record import FloatArray

ComplexArray = NDArray[np.complex128]

U, R, S = range(3)
"""Input, residual and simulated output, as rows and columns of a spectral matrix."""
SEGMENTS = 4
"""Of a record without as many periods, that overlap by half."""
BINS = 401
"""Edges of the common axis, evenly spaced in the logarithm of frequency."""
EXCITED = 1e-5
"""Of the strongest bin's input power, that an excited bin holds."""


@dataclass(frozen=True)
class Spectra:
    """Spectra summed over the lines of all records in each bin.

    Parameters
    ----------
    low, high : ndarray, shape (m,)
        Edges in Hz of the bins that hold lines.
    matrix : ndarray of complex, shape (3, 3, m)
        Auto- and cross-spectra of input, residual and simulation: row times the
        conjugate of column. Sums over bins are mean squares over all samples.
    noise : ndarray, shape (m,)
        Mean square that the noise floor gives a bin.
    """

    low: FloatArray
    high: FloatArray
    matrix: ComplexArray
    noise: FloatArray

    @property
    def frequency(self) -> FloatArray:
        """Middle of each bin, in Hz."""
        return np.asarray(np.sqrt(self.low * self.high))

    def power(self, row: int) -> FloatArray:
        """Mean square of a signal in each bin."""
        return np.asarray(self.matrix[row, row].real)

    @cached_property
    def excited(self) -> NDArray[np.bool_]:
        """Bins in which the input has power."""
        power = self.power(U)
        return np.asarray(power > EXCITED * float(np.max(power)))

    def coherence(self, a: int, b: int) -> FloatArray:
        """Coherence of two signals in each bin, from 0 to 1."""
        both = np.maximum(self.power(a) * self.power(b), 1e-300)
        return np.asarray(np.clip(np.abs(self.matrix[a, b]) ** 2 / both, 0.0, 1.0))


def take_spectra(samples: ViewSamples) -> Spectra:
    """Average the spectra of each record by Welch's method, and add the records."""
    lines = [_lines(item) for item in samples.compared]
    frequencies = np.concatenate([frequency for frequency, _ in lines])
    edges = np.geomspace(0.999 * frequencies.min(), 1.001 * frequencies.max(), BINS)
    total = sum(len(item.record) for item in samples.compared)
    # The noise is white: each line of a record has as much of it.
    weights = [
        len(item.record) / total * np.vstack([matrix, np.full_like(matrix[:1], share)])
        for item, (_, matrix) in zip(samples.compared, lines, strict=True)
        for share in [samples.noise / matrix.shape[1]]
    ]
    place = np.digitize(frequencies, edges) - 1
    held = np.zeros((len(edges) - 1, 10), dtype=np.complex128)
    np.add.at(held, place, np.hstack(weights).T)
    there = np.bincount(place, minlength=len(held)) > 0
    *matrix, noise = held[there].T
    found = np.array(matrix).reshape(3, 3, -1)
    return Spectra(edges[:-1][there], edges[1:][there], found, noise.real)


def _lines(item: Compared) -> tuple[FloatArray, ComplexArray]:
    """Average over whole periods where there are enough, else over segments.

    Returns
    -------
    frequency : ndarray, shape (m,)
    matrix : ndarray of complex, shape (9, m)
    """
    from scipy.signal import csd  # late: it takes long to load

    record = item.record
    signals = np.stack([record.u, item.residual, item.simulated])
    n, period = len(record), record.period_samples
    size, window, overlap = n // SEGMENTS, "hann", n // SEGMENTS // 2
    if period and n >= SEGMENTS * period:
        signals = whole_periods(signals, period).reshape(3, -1)
        size, window, overlap = period, "boxcar", 0
    centred = signals - signals.mean(axis=1, keepdims=True)
    frequency, matrix = csd(
        centred[None],
        centred[:, None],
        1 / record.dt,
        window=window,
        nperseg=size,
        noverlap=overlap,
        detrend=False,
    )
    return frequency[1:], matrix.reshape(9, -1)[:, 1:] * frequency[1]
