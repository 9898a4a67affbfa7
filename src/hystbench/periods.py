"""Whether an input repeats itself, and after how many samples."""

import numpy as np
from scipy import fft

from hystbench.record import FloatArray

AS_GOOD = 4.0
"""A shorter period is taken whose mean square difference is larger by up to this."""
EXACT = 1e-8
"""A mean square difference, of the variance, below which two periods are the same."""
ALIKE = 0.1
"""Share of the standard deviation: periods that differ by more, rms, are not the
same."""
RISEN = 0.5
"""Half of the variance: within a period an input differs from itself by more."""
BY_NOISE = 0.5
"""Share of what differs from one period to the next that has to be new in each. The
rest is the input itself, grown, or moved by a part of a sample."""
WHITE = 0.5
"""Roughness, of white noise one, from which what differs is noise of any input."""
LINES = 0.999
"""Share of an input's power in its own lines and their skirts, 30 dB above the rest."""
ALL = 0.9
"""Share of what differs that lies at an input's own lines, beyond what white noise has
there: from here on it is all of it, but for noise 10 dB below."""


def find_period(u: FloatArray) -> int | None:
    """Find the shortest period of an input, in samples.

    With ``d(k)`` half the mean square of ``u[t + k] - u[t]`` over the variance of
    ``u``, a period is a minimum of ``d`` behind a maximum of at least ``RISEN``: of a
    signal that repeats itself the mean of ``d`` over a period is one. It must lie
    twice in the record, and two periods may differ by ``ALIKE``: by noise, not as an
    input that grows or whose period is no whole number of samples. Of such a period a
    multiple is found that is a whole number, if it is short enough.

    Parameters
    ----------
    u : ndarray, shape (n,)

    Returns
    -------
    int or None
        None where the input does not repeat itself.
    """
    apart = differences(u)
    # Behind the first rise: a slow signal differs little from one sample to the next.
    risen = np.flatnonzero(apart >= RISEN)
    if not len(risen):
        return None
    first = int(risen[0])
    least = float(apart[first:].min())
    limit = min(max(AS_GOOD * least, EXACT), ALIKE**2 / 2)
    good = first + np.flatnonzero(apart[first:] <= limit)
    for run in np.split(good, np.flatnonzero(np.diff(good) > 1) + 1):
        if len(run):
            period = _nearest(u, int(run[np.argmin(apart[run])]))
            if repeats(u, period):
                return period
    return None


def _nearest(u: FloatArray, period: int) -> int:
    """Go from a period to one nearby by which the steadier periods differ less.

    Where an input is faded in, the mean over all of the record leads beside it.
    """
    least = _steady(u, period)[2]
    for step in (1, -1):
        while 2 * (period + step) <= len(u) and period + step > 1:
            there = _steady(u, period + step)[2]
            if there >= least:
                break
            period, least = period + step, there
    return period


def _steady(u: FloatArray, period: int) -> tuple[FloatArray, FloatArray, float]:
    """Give a period and what changes to the next, where it changes little.

    Of all periods a quarter changes less: a fade may take most of a short record.

    Returns
    -------
    before, change : ndarray, shape (m,)
    square : float
        The mean square of the change.
    """
    change = u[period:] - u[:-period]
    cuts = range(period, len(change) - period + 1, period)
    changes = np.split(change, cuts)
    squares = [float(np.mean(own**2)) for own in changes]
    place = int(np.argsort(squares)[(len(squares) - 1) // 4])
    before = u[place * period :][: len(changes[place])]
    return before, changes[place], squares[place]


def repeats(u: FloatArray, period: int) -> bool:
    """Tell whether an input repeats itself after a period, but for noise.

    Where it does not fit twice into the record, nothing contradicts it. One that grows
    changes by a share of itself; one whose period is no whole number of samples changes
    by a share of its slope. Least squares on both, and on a constant, leave what is new
    in each period. It is noise if it is rough, or not at the input's own lines alone:
    of sines that nearly come back together all of it does.
    """
    if 2 * period > len(u):
        return True
    before, change, square = _steady(u, period)
    if square <= EXACT * np.var(u):
        return True
    columns = np.column_stack([before, np.gradient(before), np.ones(len(before))])
    rest = change - columns @ np.linalg.lstsq(columns, change, rcond=None)[0]
    if float(np.mean(rest**2)) <= BY_NOISE * square:
        return False
    return _roughness(rest) > WHITE or _at_own_lines(rest, before) <= ALL


def _roughness(values: FloatArray) -> float:
    """Give what differs between neighbours, as a share of the variance: 1 if white."""
    variance = float(np.var(values))
    return (
        float(np.mean(np.diff(values) ** 2)) / (2 * variance) if variance > 0 else 0.0
    )


def _at_own_lines(rest: FloatArray, before: FloatArray) -> float:
    """Give the share of a rest that lies at an input's lines: white noise has none.

    What white noise has there is not counted; an input that is all lines tells nothing.
    """
    window = np.hanning(len(before) + 2)[1:-1]
    own, left = (
        np.abs(fft.rfft(window * (values - np.mean(values)))) ** 2
        for values in (before, rest)
    )
    strongest = np.argsort(own)[::-1]
    summed = np.cumsum(own[strongest])
    count = int(np.searchsorted(summed, LINES * summed[-1])) + 1
    by_chance = count / len(own)
    if by_chance >= 1:
        return 0.0
    share = float(left[strongest[:count]].sum() / left.sum())
    return (share - by_chance) / (1 - by_chance)


def differences(u: FloatArray) -> FloatArray:
    """Give ``d(k)`` for all lags up to half the record, shape (n // 2 + 1,)."""
    n = len(u)
    x = u - np.mean(u)
    variance = float(np.mean(x**2))
    if not variance > 0 or n < 4:
        return np.zeros(1)
    size = fft.next_fast_len(2 * n, real=True)
    spectrum = fft.rfft(x, size)
    products = fft.irfft(np.abs(spectrum) ** 2, size)[: n // 2 + 1]
    squares = np.concatenate([[0.0], np.cumsum(x**2)])
    lags = np.arange(n // 2 + 1)
    both = squares[n - lags] + squares[n] - squares[lags]
    apart = (both - 2 * products) / (2 * (n - lags) * variance)
    return np.asarray(np.maximum(apart, 0.0), dtype=np.float64)
