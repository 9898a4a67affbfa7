"""Plain loops for numba, the other way to compile: peers of the kernels."""

from __future__ import annotations

import numba
import numpy as np

from benchmarks.reference import Adapted
from hystbench.envelope import Envelope
from hystbench.record import FloatArray


@numba.njit(fastmath=True)
def _lms(line, d, taps, step, w, y):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    for k in range(len(d)):
        total = 0.0
        for i in range(taps):
            total += w[i] * line[k + i]
        y[k] = total
        change = step * (d[k] - total)
        for i in range(taps):
            w[i] += change * line[k + i]


@numba.njit(fastmath=True)
def _plays(low, high, d, r, step, w, y):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    taps = len(r)
    state = np.zeros(taps)
    for k in range(len(d)):
        total = 0.0
        for i in range(taps):
            state[i] = max(low[k + i] - r[i], min(high[k + i] + r[i], state[i]))
            total += w[i] * state[i]
        y[k] = total
        change = step * (d[k] - total)
        for i in range(taps):
            w[i] += change * state[i]


@numba.njit(fastmath=True)
def _volterra(line, d, taps, step1, step2, first, second, y):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    for k in range(len(d)):
        total = 0.0
        for i in range(taps):
            row = first[i]
            for j in range(taps):
                row += second[i, j] * line[k + j]
            total += row * line[k + i]
        y[k] = total
        error = d[k] - total
        for i in range(taps):
            first[i] += step1 * error * line[k + i]
            change = step2 * error * line[k + i]
            for j in range(taps):
                second[i, j] += change * line[k + j]


def lms(x: FloatArray, d: FloatArray, order: int, mu: float) -> Adapted:
    """LMS as :func:`benchmarks.reference.lms`."""
    w, y = np.zeros(order + 1), np.empty(len(x))
    _lms(np.concatenate((np.zeros(order), x)), d, order + 1, 2 * mu, w, y)
    return Adapted(y, w[::-1])


def play_lms(
    x: FloatArray,
    d: FloatArray,
    order: int,
    mu: float,
    thresholds: FloatArray,
    envelope: Envelope | None = None,
) -> Adapted:
    """Backlash and GPO as :func:`benchmarks.reference.play_lms`."""
    line = np.concatenate((np.zeros(order + 1), x))
    left = line if envelope is None else envelope.left(line)
    right = line if envelope is None else envelope.right(line)
    # Directed once a sample, by a finite bound: fastmath knows no infinity.
    move, none = np.diff(line), np.finfo(float).max
    low = np.where(move > 0, right[1:], -none)
    high = np.where(move < 0, left[1:], none)
    w, y = np.zeros(order + 1), np.empty(len(x))
    _plays(low, high, d, thresholds[::-1].copy(), 2 * mu, w, y)
    return Adapted(y, w[::-1])


def volterra(
    x: FloatArray, d: FloatArray, order: int, mu1: float, mu2: float
) -> Adapted:
    """Full Volterra filter as :func:`benchmarks.reference.volterra`."""
    taps = order + 1
    first, second, y = np.zeros(taps), np.zeros((taps, taps)), np.empty(len(x))
    line = np.concatenate((np.zeros(order), x))
    _volterra(line, d, taps, 2 * mu1, 2 * mu2, first, second, y)
    return Adapted(y, np.concatenate((first[::-1], second[::-1, ::-1].ravel())))
