"""Plain loops in float64 NumPy: what the kernels must equal, and one of their peers.

Each follows the paper's equations word for word and shares no code with the kernels.
``x`` before the first sample is zero, and so are weights and operators.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hystbench.envelope import Envelope
from hystbench.record import FloatArray


class Adapted(NamedTuple):
    """A priori outputs, shape (n,), and final weights of an adaptive filter."""

    output: FloatArray
    weights: FloatArray


def lms(x: FloatArray, d: FloatArray, order: int, mu: float) -> Adapted:
    """Eqs. 13 and 18 with ``H(k) = x(k) ... x(k - N)``."""
    line = np.concatenate((np.zeros(order), x))
    w, y = np.zeros(order + 1), np.empty(len(x))
    for k in range(len(x)):
        h = line[k : k + order + 1][::-1]
        y[k] = w @ h
        w += 2 * mu * (d[k] - y[k]) * h
    return Adapted(y, w)


def play_lms(
    x: FloatArray,
    d: FloatArray,
    order: int,
    mu: float,
    thresholds: FloatArray,
    envelope: Envelope | None = None,
) -> Adapted:
    """Eqs. 12, 13 and 18: the operator of threshold ``r_i`` on ``x(k - i)``.

    Without an envelope the operators are plays (backlash).
    """
    line = np.concatenate((np.zeros(order + 1), x))
    left = line if envelope is None else envelope.left(line)
    right = line if envelope is None else envelope.right(line)
    # Where the input does not rise nothing pushes up, where it does not fall nothing
    # down; by the line once, so that the loop has no more to do than it must.
    move = np.diff(line)
    low = np.where(move > 0, right[1:], -np.inf)
    high = np.where(move < 0, left[1:], np.inf)
    r = thresholds[::-1]
    w, y, state = np.zeros(order + 1), np.empty(len(x)), np.zeros(order + 1)
    for k in range(len(x)):
        now = slice(k, k + order + 1)
        state = np.maximum(low[now] - r, np.minimum(high[now] + r, state))
        y[k] = w @ state
        w += 2 * mu * (d[k] - y[k]) * state
    return Adapted(y, w[::-1])


def volterra(
    x: FloatArray, d: FloatArray, order: int, mu1: float, mu2: float
) -> Adapted:
    """Eqs. 13 and 18 with all ``x(k-i)`` and all products ``x(k-i) x(k-j)``."""
    taps = order + 1
    line = np.concatenate((np.zeros(order), x))
    w, y = np.zeros(taps + taps**2), np.empty(len(x))
    step = 2 * np.repeat([mu1, mu2], [taps, taps**2])
    for k in range(len(x)):
        h1 = line[k : k + taps][::-1]
        h = np.concatenate((h1, np.outer(h1, h1).ravel()))
        y[k] = w @ h
        w += step * (d[k] - y[k]) * h
    return Adapted(y, w)


def prandtl_ishlinskii(
    left: FloatArray, right: FloatArray, thresholds: FloatArray, weights: FloatArray
) -> FloatArray:
    """Eqs. 4 and 9 from rest."""
    state, y = np.zeros(len(thresholds)), np.empty(len(left))
    for k in range(len(left)):
        state = np.maximum(
            right[k] - thresholds, np.minimum(left[k] + thresholds, state)
        )
        y[k] = weights @ state
    return y


def rate_dependent(
    v: FloatArray, spacing: FloatArray, ratio: FloatArray, count: int
) -> FloatArray:
    """Plays of threshold ``i spacing(k)`` and weight ``ratio(k)^i``, from rest."""
    number, state, y = np.arange(count), np.zeros(count), np.empty(len(v))
    for k in range(len(v)):
        r = number * spacing[k]
        state = np.maximum(v[k] - r, np.minimum(v[k] + r, state))
        y[k] = ratio[k] ** number @ state
    return y


def equal(ours: Adapted, plain: Adapted, tolerance: float = 1e-9) -> bool:
    """Tell whether outputs and weights agree, relative to the largest of each."""
    return all(
        a.shape == b.shape and np.abs(a - b).max() <= tolerance * np.abs(b).max()
        for a, b in zip(ours, plain, strict=True)
    )
