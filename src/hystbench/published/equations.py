"""Equations 1-12 of the paper as printed, written out plainly.

The ledger of claims judges the printed equations, also where two of them differ
(Eq. 4 and Eq. 12), so they stand here apart from the operators that the filters
run.
"""

from collections.abc import Mapping

import numpy as np

from hystbench.record import FloatArray

Envelope = Mapping[str, float]


def gamma_left(v: FloatArray, envelope: Envelope) -> FloatArray:
    """Envelope of the falling input, Eq. 5: a0 tanh(a1 v + a2) + a3."""
    a = envelope
    return np.asarray(a["a0"] * np.tanh(a["a1"] * v + a["a2"]) + a["a3"])


def gamma_right(v: FloatArray, envelope: Envelope) -> FloatArray:
    """Envelope of the rising input, Eq. 6: a4 tanh(a5 v + a6) + a7."""
    a = envelope
    return np.asarray(a["a4"] * np.tanh(a["a5"] * v + a["a6"]) + a["a7"])


def thresholds(order: int, maximum: float, envelope: Envelope) -> FloatArray:
    """Thresholds r_0 to r_N, Eq. 10, for an input of the largest size ``maximum``."""
    top = np.array([maximum])
    reach = max(gamma_right(top, envelope)[0], gamma_left(top, envelope)[0])
    return np.asarray(np.arange(order + 1) / (order + 1) * reach)


def _clamp(rising: FloatArray, falling: FloatArray, r: FloatArray) -> FloatArray:
    """Follow f(v, w) = max(rising - r, min(falling + r, w)) from w = f(v(0), 0)."""
    out = np.empty((len(rising), len(r)))
    state = np.zeros(len(r))
    for k in range(len(rising)):
        state = np.maximum(rising[k] - r, np.minimum(falling[k] + r, state))
        out[k] = state
    return out


def play(v: FloatArray, r: FloatArray) -> FloatArray:
    """Run play operators, Eqs. 1-2; shape (samples, thresholds)."""
    return _clamp(v, v, r)


def generalized_play(v: FloatArray, r: FloatArray, envelope: Envelope) -> FloatArray:
    """Run generalized play operators, Eqs. 3-4; shape (samples, thresholds)."""
    return _clamp(gamma_right(v, envelope), gamma_left(v, envelope), r)


def generalized_play_eq12(
    v: FloatArray, r: FloatArray, envelope: Envelope
) -> FloatArray:
    """Run generalized play operators by Eq. 12, from x(-1) = 0 and H = 0."""
    rising, falling = gamma_right(v, envelope), gamma_left(v, envelope)
    out = np.empty((len(v), len(r)))
    state = np.zeros(len(r))
    before = 0.0
    for k, now in enumerate(v):
        if now > before:
            state = np.maximum(state, rising[k] - r)
        elif now < before:
            state = np.minimum(state, falling[k] + r)
        out[k] = state
        before = float(now)
    return out
