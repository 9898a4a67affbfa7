"""Spectra of all records on one frequency axis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from hystbench.gap.locate.samples import Samples
from hystbench.record import FloatArray

ComplexArray = NDArray[np.complex128]

# Bins of the common axis, evenly spaced in the logarithm of frequency.
BINS = 400
# What a Hann window does to the variance of a cross-spectrum's sum: n sum w^4 over
# the square of sum w^2.
HANN_INFLATION = 35 / 18


@dataclass(frozen=True)
class Spectra:
    """Hann-windowed auto- and cross-spectra, summed over records in each bin.

    Scaled so that the residual's spectrum sums to its mean square over all samples.

    Parameters
    ----------
    frequency : ndarray, shape (m,)
        Mean frequency of each bin in Hz, weighted by the simulated output's power.
    low, high : ndarray, shape (m,)
        Edges of each bin in Hz.
    residual, simulated, noise : ndarray, shape (m,)
        Power of the residual, of the simulated output, and what the floor would give.
    cross : ndarray of complex, shape (m,)
        Residual times the conjugate of the simulated output.
    """

    frequency: FloatArray
    low: FloatArray
    high: FloatArray
    residual: FloatArray
    simulated: FloatArray
    noise: FloatArray
    cross: ComplexArray

    @property
    def linear(self) -> FloatArray:
        """Power that a gain and a phase of each bin's own would explain."""
        return np.abs(self.cross) ** 2 / np.maximum(self.simulated, 1e-300)


def take_spectra(samples: Samples) -> Spectra:
    """Work out the spectra of all records, every bin that any record has."""
    frequencies, residuals, simulateds, crosses, noises = [], [], [], [], []
    total = sum(len(item.record) for item in samples.compared)
    for item in samples.compared:
        n = len(item.record)
        window = np.hanning(n)
        length = fft.next_fast_len(n, real=True)
        pair = np.stack([item.residual, item.simulated])
        pair = pair - pair.mean(axis=1, keepdims=True)
        r, s = fft.rfft(pair * window, length, axis=1)[:, 1:]
        # One-sided, and a record weighs by its length.
        scale = 2 * n / (length * float(np.sum(window**2)) * total)
        frequencies.append(fft.rfftfreq(length, item.record.dt)[1:])
        residuals.append(scale * np.abs(r) ** 2)
        simulateds.append(scale * np.abs(s) ** 2)
        crosses.append(scale * r * np.conj(s))
        noises.append(np.full(len(r), samples.noise * 2 * n / (length * total)))
    frequency = np.concatenate(frequencies)
    edges = np.geomspace(frequency.min() * 0.999, frequency.max() * 1.001, BINS + 1)
    bins = np.digitize(np.log(frequency), np.log(edges)) - 1

    def gather(values: FloatArray) -> FloatArray:
        return np.bincount(bins, values, BINS).astype(np.float64)

    simulated = np.concatenate(simulateds)
    cross = np.concatenate(crosses)
    weight = simulated + 1e-12 * np.mean(simulated) + 1e-300
    used = gather(np.ones_like(frequency)) > 0
    mean = gather(weight * frequency)[used] / gather(weight)[used]
    return Spectra(
        frequency=mean,
        low=edges[:-1][used],
        high=edges[1:][used],
        residual=gather(np.concatenate(residuals))[used],
        simulated=gather(simulated)[used],
        noise=gather(np.concatenate(noises))[used],
        cross=gather(cross.real)[used] + 1j * gather(cross.imag)[used],
    )
