"""The band-limited signal through the samples of a record, as a sum of sines."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hystbench.record import FloatArray

ComplexArray = NDArray[np.complex128]


class SineSeries(NamedTuple):
    """A straight line and sines that vanish at both its ends.

    The signal at sample m, whole or not, is ``start + slope m + sum_k b_k
    sin(pi k m / half)``, ``b_k = -Im(spectrum[k]) / half``.
    """

    start: float
    slope: float  # per sample
    spectrum: ComplexArray  # shape (half + 1,): of the sines, continued as odd
    half: int  # samples of half a period of the first sine

    def frequency_hz(self, dt: float) -> FloatArray:
        """Frequency of each sine in Hz, the first being zero."""
        return np.arange(self.half + 1) / (2 * self.half * dt)

    def amplitudes(self) -> FloatArray:
        """Amplitudes b_k, the first for frequency zero."""
        return -self.spectrum.imag / self.half

    def line(self, count: int, shift: float = 0.0, factor: int = 1) -> FloatArray:
        """Sample the straight line, ``shift`` samples later, ``factor`` times finer."""
        places = np.arange(count) / factor - shift
        return self.start + self.slope * places

    def sines(
        self, count: int, response: ComplexArray | FloatArray | float, factor: int = 1
    ) -> FloatArray:
        """Sample the sines after a frequency response, as if they always had been."""
        spectrum = self.spectrum * response
        return factor * np.fft.irfft(spectrum, 2 * factor * self.half)[:count]


def sine_series(v: FloatArray) -> SineSeries:
    """Find the band-limited signal through samples.

    The straight line through both ends is taken off and what is left is continued
    as an odd function about both, so that nothing jumps there. Before that the
    record is continued as odd about its end, by a few percent at most, to a length
    that the Fourier transform likes.

    Parameters
    ----------
    v : ndarray, shape (n,)
        At least two samples.
    """
    from scipy.fft import next_fast_len  # late: a filter's process never needs it

    n = len(v)
    half = int(next_fast_len(n - 1))
    if half > n - 1:
        v = np.concatenate([v, 2 * v[-1] - v[n - 2 : 2 * n - half - 3 : -1]])
    slope = float(v[-1] - v[0]) / half
    rest = v - (v[0] + slope * np.arange(half + 1))
    odd = np.concatenate([rest[:-1], -rest[:0:-1]])
    return SineSeries(float(v[0]), slope, np.fft.rfft(odd), half)


def interpolate(v: FloatArray, factor: int) -> FloatArray:
    """Sample the band-limited signal ``factor`` times finer.

    Returns
    -------
    ndarray, shape ((n - 1) factor + 1,)
        Equal to ``v`` at every ``factor``-th sample.
    """
    series = sine_series(v)
    count = (len(v) - 1) * factor + 1
    return series.line(count, 0.0, factor) + series.sines(count, 1.0, factor)


def finer(v: FloatArray, factor: int) -> FloatArray:
    """Do what :func:`interpolate` does, once for a signal that comes back.

    A fit sends the same signal through hysteresis with other parameters. The result is
    shared: it must not be written to.
    """
    return _finer(v.tobytes(), factor)


@lru_cache(maxsize=32)
def _finer(samples: bytes, factor: int) -> FloatArray:
    fine = interpolate(np.frombuffer(samples), factor)
    fine.setflags(write=False)
    return fine


def straight_lines(v: FloatArray, factor: int) -> FloatArray:
    """Find corners whose straight lines hold the band-limited signal's sines.

    Straight lines through samples of a sine hold that sine ``sinc^2`` times too
    small, and others at multiples of the new sampling rate. The first is made good
    here, the others a finer grid makes small: at 1/20 of the sampling rate of ``v``
    and twice as fine they have 0.07 % of its amplitude.

    Parameters
    ----------
    v : ndarray, shape (n,)
    factor : int

    Returns
    -------
    ndarray, shape ((n - 1) * factor + 1,)
    """
    series = sine_series(v)
    count = (len(v) - 1) * factor + 1
    share = np.sinc(np.arange(series.half + 1) / (2 * series.half * factor)) ** 2
    return series.line(count, factor=factor) + series.sines(count, 1 / share, factor)
