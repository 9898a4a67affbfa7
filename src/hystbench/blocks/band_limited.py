"""The band-limited signal through the samples of a record, as a sum of sines."""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import NamedTuple, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from hystbench.record import FloatArray

ComplexArray = NDArray[np.complex128]


Result = TypeVar("Result")


class Kept:
    """Results for signals that cannot change: a fit sends the same one in many times.

    A signal is known by its place in memory for as long as it lives. One that may be
    written to is never kept.
    """

    def __init__(self) -> None:
        self._known: dict[tuple[int, str, int], object] = {}
        self._watched: dict[int, weakref.ref[FloatArray]] = {}

    def get(
        self, v: FloatArray, kind: str, number: int, compute: Callable[[], Result]
    ) -> Result:
        """Look up what was computed of a signal, or compute it."""
        if v.flags.writeable or v.base is not None:
            return compute()
        key = (id(v), kind, number)
        if key not in self._known:
            if id(v) not in self._watched:
                self._watched[id(v)] = weakref.ref(v, self._forget(id(v)))
            self._known[key] = compute()
        return cast("Result", self._known[key])

    def _forget(self, place: int) -> Callable[[object], None]:
        def forget(_: object) -> None:
            self._watched.pop(place, None)
            for key in [key for key in self._known if key[0] == place]:
                del self._known[key]

        return forget


_kept = Kept()


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
        At least two samples. Of one that cannot be written to, the series is kept.
    """
    return _kept.get(v, "series", 1, lambda: _sine_series(v))


def _sine_series(v: FloatArray) -> SineSeries:
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


def coarser(v: FloatArray, factor: int) -> FloatArray:
    """Sample a signal ``factor`` times coarser, as behind an ideal low-pass filter.

    What is above half of the coarse sampling rate is left out: for a signal that has
    nothing there this undoes :func:`interpolate`.

    Returns
    -------
    ndarray, shape ((n - 1) // factor + 1,)
    """
    series = _sine_series(v)
    kept = np.where(np.arange(series.half + 1) * factor < series.half, 1.0, 0.0)
    signal: FloatArray = series.line(len(v)) + series.sines(len(v), kept)
    return signal[::factor].copy()


def finer(v: FloatArray, factor: int) -> FloatArray:
    """Do what :func:`interpolate` does, once for a signal that cannot be written to.

    The result cannot be written to either.
    """

    def compute() -> FloatArray:
        fine = interpolate(v, factor)
        fine.setflags(write=False)
        return fine

    return _kept.get(v, "finer", factor, compute)


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


def held_lines(v: FloatArray, hold: str) -> tuple[FloatArray, int]:
    """Give the corners of the straight lines that a block moves along.

    Parameters
    ----------
    v : ndarray, shape (n,)
    hold : {"zero-order", "linear", "band-limited"}
        A band-limited signal is taken as :func:`straight_lines` twice as fine.

    Returns
    -------
    corners : ndarray, shape ((n - 1) * lines + 1,)
    lines : int
        How many there are between two samples.
    """
    if hold == "band-limited" and len(v) > 2:
        return straight_lines(v, 2), 2
    return np.ascontiguousarray(v), 1
