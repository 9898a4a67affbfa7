"""The best linear approximation of a map, and a record filtered by its inverse."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hystbench.errors import InputError
from hystbench.record import FloatArray

Map = Callable[[FloatArray], FloatArray]

DRAWS = 3
"""Draws of the phases: what is nonlinear differs from one to the next."""
NEIGHBOURS = 0.15
"""How far neighbours lie at most, as a share of the frequency."""
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
        """Interpolate size and phase; a constant has the gain and no phase."""
        at, size = np.append(0.0, self.frequency_hz), np.abs(self.value)
        phase = np.unwrap(np.angle(self.value))
        still = 0.0 if self.gain > 0 else np.copysign(np.pi, phase[0])
        found = np.interp(frequency_hz, at, np.append(size[0], size))
        turned = np.interp(frequency_hz, at, np.append(still, phase))
        whole: NDArray[np.complex128] = found * np.exp(1j * turned)
        return whole


def best_linear(
    map_: Map,
    size: float,
    count: int,
    dt: float,
    band_hz: float,
    hysteretic: bool = False,
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
    hysteretic : bool
        Whether neighbouring frequencies are averaged: where the map has hysteresis,
        what the strong sines make of it hides the response to the weak ones.

    Raises
    ------
    InputError
        If no input makes an output of that size, or the map runs away with it.
    """
    lines = np.arange(1, max(int(band_hz * count * dt), 2) + 1)
    random = np.random.default_rng(1)
    spectra = np.zeros((DRAWS, count // 2 + 1), complex)
    # Slow motion carries the stroke: the sines fall off with their frequency.
    phases = random.uniform(0, 2 * np.pi, (DRAWS, len(lines)))
    spectra[:, lines] = np.exp(1j * phases) / lines
    draws = np.fft.irfft(spectra, count)
    draws /= np.abs(draws).max(axis=1, keepdims=True)
    rest = float(map_(np.zeros(8))[-1])
    scale = _scaled(map_, draws[0], size)
    inputs = np.fft.rfft(scale * draws)
    settled = [map_(np.tile(scale * u, 2))[count:] for u in draws]
    if not np.isfinite(settled).all():
        raise InputError(
            f"reference: at a stroke of {size:g} the model's output diverges; "
            "expected a smaller reference"
        )
    outputs = np.fft.rfft(np.array(settled))
    cross = (outputs * inputs.conj()).sum(axis=0)[lines]
    power = (np.abs(inputs) ** 2).sum(axis=0)[lines]
    if hysteretic:
        # A sine of line k has the power 1 / k^2: all count alike.
        cross, power = _averaged(cross * lines**2), _averaged(power * lines**2)
    return Response(lines / (count * dt), cross / power, rest)


def _averaged(values: NDArray[Any]) -> NDArray[Any]:
    """Average over neighbours, as far as :data:`NEIGHBOURS` of the frequency."""
    half = (NEIGHBOURS * np.arange(1, len(values) + 1)).astype(int)
    place = np.arange(len(values))
    low, high = np.maximum(place - half, 0), np.minimum(place + half + 1, len(values))
    total = np.append(0.0, np.cumsum(values))
    averaged: NDArray[Any] = (total[high] - total[low]) / (high - low)
    return averaged


def _scaled(map_: Map, u: FloatArray, size: float) -> float:
    """Find a factor on an input for which the output is about of a size.

    Where the output jumps over that size, it is the factor that comes nearest.
    """
    scale, low, high, best = 1.0, 0.0, np.inf, (np.inf, 1.0)
    for _ in range(TRIES):
        reached = float(np.ptp(map_(np.tile(scale * u, 2))[len(u) :]))
        off = abs(np.log(reached / size)) if 0 < reached < np.inf else np.inf
        best = min(best, (off, scale))
        if off < 0.2:
            break
        if reached < size:
            low = max(low, scale)
        else:  # too large, or no number
            high = min(high, scale)
        step = min(max(size / reached, 0.1), 10.0) if off < np.inf else 10.0
        if low and high < np.inf:
            scale = float(np.sqrt(low * high))
        else:
            scale *= step if reached < size else min(step, 0.5)
        if high / max(low, 1e-300) < 1.01:
            break
    if best[0] == np.inf or (high == np.inf and best[0] > 0.2):
        most = 0.0 if best[0] == np.inf else size * float(np.exp(-best[0]))
        raise InputError(
            f"reference: a stroke of {size:g}; the model makes at most {most:.4g}"
        )
    return best[1]


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
