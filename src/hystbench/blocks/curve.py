"""The smooth curve through the samples of a record: what ``band-limited`` holds.

Between two samples the curve is the polynomial through the sixteen samples on either
side. It knows no more of a record than that: code that runs sample by sample, fifteen
samples late, takes the same curve. A sine is met within 1e-12 of its amplitude up to
0.15 of the sampling rate, within 1e-8 up to a fifth and within 3e-6 up to a quarter.
"""

from collections.abc import Callable
from functools import lru_cache
from math import factorial

import numpy as np

from hystbench import kernels
from hystbench.record import FloatArray

AHEAD = 15
"""Samples to come that the curve needs beyond the end of an interval."""
POINTS = 2 * AHEAD + 2
"""Samples that it goes through."""
CENTRAL = np.array([-0.5, 0.0, 0.5])
"""Weights of a sample and its neighbours for the central difference, per sample."""


def through_samples(
    points: int, moment: Callable[[int], float | FloatArray], origin: float = 0.0
) -> FloatArray:
    """Find what a linear functional takes of the polynomial through the newest samples.

    Parameters
    ----------
    points : int
        Samples, the newest at time 0 and the others at -1, -2 and so on.
    moment : callable
        Gives the functional of ``(t - origin)^m`` from m.
    origin : float
        A time where the functional looks: about it powers are well told apart.

    Returns
    -------
    ndarray, shape (points,) or (points, k)
        Weights of the samples, the newest first; ``(points, k)`` for k functionals.
    """
    basis = _basis(points, float(origin))
    weights: FloatArray = basis @ np.array([moment(m) for m in range(points)])
    return weights


@lru_cache(maxsize=256)
def _basis(points: int, origin: float) -> FloatArray:
    """Give the polynomials that are one at a sample and zero at the others."""
    places = -np.arange(points) - origin
    basis = np.zeros((points, points))
    basis[:, 0] = 1.0
    # The nearest zeros first: so the coefficients grow step by step.
    for j in np.argsort(np.abs(places), kind="stable"):
        others = np.arange(points) != j
        rows = basis[others]
        basis[others, 1:] = rows[:, :-1]
        basis[others, 0] = 0.0
        basis[others] -= places[j] * rows
    basis /= _distances(points)[:, None]
    basis.setflags(write=False)
    return basis


@lru_cache(maxsize=8)
def _distances(points: int) -> FloatArray:
    """Give the product of each sample's distances to the others, with their signs."""
    apart = np.subtract.outer(-np.arange(points), -np.arange(points)).astype(float)
    np.fill_diagonal(apart, 1.0)
    products: FloatArray = apart.prod(axis=1)
    return products


def value_at(points: int, place: float) -> FloatArray:
    """Weights of the samples for the curve's value at a time, the newest at 0."""
    away = np.tile(place + np.arange(points), (points, 1))
    np.fill_diagonal(away, 1.0)
    weights: FloatArray = away.prod(axis=1) / _distances(points)
    return weights


def derivative_at(points: int, place: float, order: int) -> FloatArray:
    """Weights of the samples for a derivative of the curve, per sample to its order."""
    size = float(factorial(order))
    return through_samples(points, lambda m: size * (m == order), place)


def central_difference(points: int, place: float, half_width: float) -> FloatArray:
    """Weights of the samples for a central difference of the curve, per sample."""

    def moment(m: int) -> float:
        return (half_width**m - (-half_width) ** m) / (2 * half_width)

    return through_samples(points, moment, place)


def about_sample(weights: FloatArray, points: int, ahead: int) -> FloatArray:
    """Weights of the newest samples for a difference about one of them.

    Where the samples that it takes are known it is that of these alone.

    Parameters
    ----------
    weights : ndarray, shape (2 k + 1,)
        Of the sample, the k before it and the k after it, the oldest first.
    points, ahead : int
        Samples that a curve goes through; so many of them are later.

    Returns
    -------
    ndarray, shape (points,)
        The newest first.
    """
    reach = len(weights) // 2
    if ahead < reach:
        around = np.arange(-reach, reach + 1.0)
        return through_samples(points, lambda m: float(weights @ around**m), -ahead)
    taken = np.zeros(points)
    taken[ahead - reach : ahead + reach + 1] = weights[::-1]
    return taken


def corner(points: int, place: float) -> FloatArray:
    """Weights of the samples for a corner of :func:`held_lines`, twice as fine.

    Straight lines through samples of a sine hold that sine ``sinc^2`` times too small,
    and others at multiples of the new sampling rate. The first is made good here, the
    others a finer grid makes small: at 1/20 of the sampling rate and twice as fine
    they have 0.07 % of its amplitude. ``1 / sinc^2`` of a frequency w is ``1 +
    (w h)^2 / 12 + (w h)^4 / 240 + ...`` with the corners h apart: so much of the
    curve's second and fourth derivative, with their signs, is added to its value.
    """
    h = 0.5
    share = {0: 1.0, 2: -(h**2) / 12 * 2, 4: h**4 / 240 * 24}
    return through_samples(points, lambda m: share.get(m, 0.0), place)


def continued(v: FloatArray) -> FloatArray:
    """Go on at both ends of a record, as the curve needs it.

    With what the record is there, turned about its first or its last sample: so
    neither value nor slope jumps. A record too short for that goes on straight.

    Parameters
    ----------
    v : ndarray, shape (n,)

    Returns
    -------
    ndarray, shape (n + POINTS - 1,)
        Sample k at ``k + AHEAD + 1``.
    """
    return _turned(v, AHEAD + 1, AHEAD)


def _turned(v: FloatArray, before: int, behind: int) -> FloatArray:
    """Go on so many samples before and behind a record."""
    n = len(v)
    out = np.empty(before + n + behind)
    out[before : before + n] = v
    known, end = min(n - 1, before), before + n
    out[before - known : before] = 2 * v[0] - v[known:0:-1]
    for k in range(before - known - 1, -1, -1):
        out[k] = 2 * out[k + 1] - out[k + 2] if n > 1 else v[0]
    known = min(n - 1, behind)
    out[end : end + known] = 2 * v[-1] - v[::-1][1 : known + 1]
    for k in range(end + known, len(out)):
        out[k] = 2 * out[k - 1] - out[k - 2] if n > 1 else v[0]
    return out


def weighed(v: FloatArray, weights: FloatArray) -> FloatArray:
    """Weigh, for every sample, those that the curve before it goes through.

    Parameters
    ----------
    v : ndarray, shape (n,)
    weights : ndarray, shape (count, POINTS)
        Of the samples from ``AHEAD`` later on, the newest first.

    Returns
    -------
    ndarray, shape (count, n)
    """
    rows = np.ascontiguousarray(weights[:, ::-1])
    out = np.empty((len(rows), len(v)))
    kernels.call("hb_weighed", len(v), POINTS, len(rows), rows, continued(v), out)
    return out


@lru_cache(maxsize=64)
def _between(factor: int) -> FloatArray:
    places = np.arange(1 - factor, 0) / factor - AHEAD
    return np.array([value_at(POINTS, place) for place in places])


def finer(v: FloatArray, factor: int) -> FloatArray:
    """Sample the curve ``factor`` times finer.

    Parameters
    ----------
    v : ndarray, shape (n,)
    factor : int

    Returns
    -------
    ndarray, shape ((n - 1) factor + 1,)
        Equal to ``v`` at every ``factor``-th sample.
    """
    out = np.empty((len(v) - 1) * factor + 1)
    out[::factor] = v
    if factor > 1:
        inner = out[1:].reshape(-1, factor)[:, :-1]
        inner[...] = weighed(v, _between(factor)).T[1:]
    return out


def held_lines(v: FloatArray, hold: str) -> tuple[FloatArray, int]:
    """Give the corners of the straight lines that a block moves along.

    Parameters
    ----------
    v : ndarray, shape (n,)
    hold : {"zero-order", "linear", "band-limited"}
        A curve is taken as straight lines twice as fine, see :func:`corner`.

    Returns
    -------
    corners : ndarray, shape ((n - 1) * lines + 1,)
    lines : int
        How many there are between two samples.
    """
    if hold != "band-limited" or len(v) < 3:
        return np.ascontiguousarray(v), 1
    middle, end = weighed(v, _corners())
    lines = np.empty(2 * len(v) - 1)
    lines[::2], lines[1::2] = end, middle[1:]
    return lines, 2


@lru_cache(maxsize=1)
def _corners() -> FloatArray:
    return np.array([corner(POINTS, -0.5 - AHEAD), corner(POINTS, -AHEAD)])


SHORT_STEPS = 8
"""Steps of a sampling interval for what may turn between two samples.

Hysteresis and friction take that many where the input is band-limited.
"""
_RINGS = AHEAD - 1
"""Coarse samples on either side that the filter of :func:`coarser` reaches."""
_STOP = 60.0
"""Attenuation of that filter in dB, from 0.57 of the coarse sampling rate on."""


@lru_cache(maxsize=1)
def low_pass_taps() -> FloatArray:
    """Give the filter of :func:`coarser`: a sine over its argument, in Kaiser's window.

    References
    ----------
    .. [1] J. F. Kaiser, R. W. Schafer, "On the use of the I0-sinh window for spectrum
       analysis", IEEE Transactions on Acoustics, Speech, and Signal Processing 28
       (1980) 105-107.

    Returns
    -------
    ndarray, shape (2 SHORT_STEPS _RINGS + 1,)
        Not to be written to.
    """
    place = np.arange(-SHORT_STEPS * _RINGS, SHORT_STEPS * _RINGS + 1)
    taps: FloatArray = np.sinc(place / SHORT_STEPS) * np.kaiser(
        len(place), 0.1102 * (_STOP - 8.7)
    )
    taps /= taps.sum()
    taps.setflags(write=False)
    return taps


def coarser(v: FloatArray) -> FloatArray:
    """Sample a signal :data:`SHORT_STEPS` times coarser, behind a low-pass filter.

    What is above half of the coarse sampling rate is left out, as by an instrument that
    samples without aliasing. The signal goes on at both ends, turned about them.

    Parameters
    ----------
    v : ndarray, shape ((n - 1) SHORT_STEPS + 1,)

    Returns
    -------
    ndarray, shape (n,)
    """
    taps = low_pass_taps()
    count, reach = (len(v) - 1) // SHORT_STEPS + 1, len(taps) // 2
    around = _turned(v, reach, reach)
    out = np.empty(count)
    kernels.call("hb_decimated", count, SHORT_STEPS, len(taps), taps, around, out)
    return out
