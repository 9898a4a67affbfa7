"""The best linear approximation of a map, and a record filtered by its inverse."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hystbench.errors import InputError
from hystbench.record import FloatArray

Map = Callable[[FloatArray], FloatArray]

LINES = 40
"""Sines of an excitation, evenly spaced in the logarithm of their frequency."""
TRIES = 30
"""How often the size of the excitation is corrected, at most."""


class Response(NamedTuple):
    """Best linear approximation of a map for one size of its output [1]_.

    References
    ----------
    .. [1] R. Pintelon, J. Schoukens, System Identification: A Frequency Domain
       Approach, 2nd ed., Wiley, 2012, chapter 3.
    """

    frequency_hz: FloatArray  # shape (k,), rising
    value: NDArray[np.complex128]  # shape (k,)
    rest: float  # output of a zero input

    @property
    def gain(self) -> float:
        """What a slow input is multiplied by."""
        return float(self.value[0].real)

    def at(self, frequency_hz: FloatArray) -> NDArray[np.complex128]:
        """Interpolate size and phase; a constant is multiplied by the gain."""
        size = np.interp(frequency_hz, self.frequency_hz, np.abs(self.value))
        phase = np.unwrap(np.angle(self.value))
        turned = np.interp(frequency_hz, self.frequency_hz, phase)
        found = size * np.exp(1j * turned)
        return np.where(frequency_hz < self.frequency_hz[0], self.gain, found)


def best_linear(
    map_: Map, size: float, count: int, dt: float, band_hz: float, seed: int = 1
) -> Response:
    """Estimate the best linear approximation by a sum of sines of random phases.

    Parameters
    ----------
    map_ : callable
        From input to output, as arrays of one length.
    size : float
        Peak-to-peak of the output that the excitation is to make.
    count : int
        Samples of one period of the excitation.
    dt : float
        Sampling interval in seconds.
    band_hz : float
        Highest frequency.
    seed : int
        Draws the phases.

    Raises
    ------
    InputError
        If no input makes an output of that size.
    """
    last = max(int(band_hz * count * dt), 2)
    lines = np.unique(np.geomspace(1, last, LINES).round().astype(int))
    phases = np.random.default_rng(seed).uniform(0, 2 * np.pi, len(lines))
    spectrum = np.zeros(count // 2 + 1, complex)
    # Slow motion carries the stroke: the sines fall off as those of a triangle.
    spectrum[lines] = np.exp(1j * phases) / np.sqrt(lines)
    sines = np.fft.irfft(spectrum, count)
    u = sines / np.abs(sines).max()
    rest = float(map_(np.zeros(8))[-1])
    scale, known = 1.0, 0.0
    for _ in range(TRIES):
        y = map_(np.tile(scale * u, 2))[count:]
        reached = float(np.ptp(y))
        if not np.isfinite(reached) or reached == 0:
            scale *= 0.1 if reached else 10.0
            continue
        known = max(known, reached)
        factor = size / reached
        if 0.8 < factor < 1.25:
            found = np.fft.rfft(y)[lines] / np.fft.rfft(scale * u)[lines]
            return Response(lines / (count * dt), found, rest)
        scale *= min(max(factor, 0.1), 10.0)
    raise InputError(
        f"reference: a stroke of {size:g}; the model makes at most {known:.4g}"
    )


def without(
    response: Response, error: FloatArray, dt: float, band_hz: float
) -> FloatArray:
    """Filter a record by the inverse of a response, within a band.

    The record is continued as odd about both ends, so that nothing jumps there. The
    filter falls off by a cosine from the band's edge to one and a half times that.

    Returns
    -------
    ndarray, shape (n,)
    """
    n = len(error)
    before, after = 2 * error[0] - error[:0:-1], 2 * error[-1] - error[-2::-1]
    long = np.concatenate([before, error, after])
    middle = long.mean()
    frequency = np.asarray(np.fft.rfftfreq(len(long), dt), dtype=np.float64)
    over = np.clip((frequency / band_hz - 1) / 0.5, 0.0, 1.0)
    passed = 0.5 * (1 + np.cos(np.pi * over))
    found = np.fft.irfft(
        np.fft.rfft(long - middle) * passed / response.at(frequency), len(long)
    )
    whole: FloatArray = found + middle / response.gain
    return whole[n - 1 : 2 * n - 1]
