"""Pairs of envelopes that are feasible by construction, in seven numbers.

Eqs. 5-6 have eight parameters, one of which is the scale: envelopes and thresholds
times s with weights over s are the same model. Here the right envelope rises by one
over the range of the input, and what is left is free within plain bounds:

======================= ==========================================================
``log slope``, twice    steepness of tanh over half the range, right and left
``phase``, twice        argument of tanh in the middle of the range
``log rise ratio``      rise of the left envelope over that of the right one
``gap``                 least distance from the right envelope up to the left one
``log span``            the factor max{...} of Eq. 10, in rises
======================= ==========================================================

Every point within :data:`LOWER` and :data:`UPPER` gives increasing envelopes with
the left one nowhere below the right one on the range.
"""

from dataclasses import replace
from typing import cast

import numpy as np

from hystbench.envelope import Envelope
from hystbench.record import FloatArray

_LOG = np.array([True, False, True, False, True, False, True])


def _box(*values: float) -> FloatArray:
    point = np.array(values, dtype=np.float64)
    point[_LOG] = np.log(point[_LOG])
    return point


# the least gap is above the error of looking for a maximum on a grid
LOWER = _box(0.02, -2.5, 0.02, -2.5, 0.03, 1e-4, 0.02)
UPPER = _box(10.0, 2.5, 10.0, 2.5, 30.0, 10.0, 50.0)

_GRID = np.linspace(-1.0, 1.0, 257)


def envelope_of(point: FloatArray, low: float, high: float) -> Envelope:
    """Build the pair of envelopes at a point, for inputs from ``low`` to ``high``.

    Parameters
    ----------
    point : ndarray, shape (7,)
        Within :data:`LOWER` and :data:`UPPER`.
    low, high : float
        Range of the input.

    Returns
    -------
    Envelope
        Its right envelope rises by one from ``low`` to ``high``.
    """
    slope_right, slope_left, ratio, span = np.exp(point[[0, 2, 4, 6]])
    phase_right, phase_left, gap = point[[1, 3, 5]]
    rise_right, base_right = _unit_rise(slope_right, phase_right)
    rise_left, base_left = _unit_rise(slope_left, phase_left)

    def right(x: FloatArray) -> FloatArray:
        shape = rise_right * np.tanh(slope_right * x + phase_right) + base_right
        return cast(FloatArray, shape)

    def left(x: FloatArray) -> FloatArray:
        shape = rise_left * np.tanh(slope_left * x + phase_left) + base_left
        return cast(FloatArray, ratio * shape)

    distance = gap + _maximum(right(_GRID) - left(_GRID))
    middle, half = (low + high) / 2, (high - low) / 2
    top = np.array([(max(abs(low), abs(high)) - middle) / half])
    shift = span - max(right(top)[0], left(top)[0] + distance)
    return Envelope(
        a0=float(ratio * rise_left),
        a1=float(slope_left / half),
        a2=float(phase_left - slope_left * middle / half),
        a3=float(ratio * base_left + distance + shift),
        a4=float(rise_right),
        a5=float(slope_right / half),
        a6=float(phase_right - slope_right * middle / half),
        a7=float(base_right + shift),
    )


def random_point(random: np.random.Generator) -> FloatArray:
    """Draw a point among shapes that actuators show: neither lines nor steps."""
    low = _box(0.1, -1.0, 0.1, -1.0, 0.6, 1e-4, 0.2)
    high = _box(3.0, 1.0, 3.0, 1.0, 1.6, 0.3, 2.0)
    return low + (high - low) * random.random(len(low))


def plain_point() -> FloatArray:
    """Start from equal, gently bent envelopes whose thresholds span half a rise."""
    return _box(0.7, 0.0, 0.7, 0.0, 1.0, 0.02, 0.5)


def envelope_scale(envelope: Envelope, low: float, high: float) -> float:
    """Find the largest magnitude of both envelopes on a range.

    They are monotone, so it is at an end.
    """
    ends = np.array([low, high])
    both = np.concatenate([envelope.left(ends), envelope.right(ends)])
    return float(np.max(np.abs(both)))


def rescaled(envelope: Envelope, factor: float) -> Envelope:
    """Multiply both envelopes by a positive factor."""
    return replace(
        envelope,
        a0=envelope.a0 * factor,
        a3=envelope.a3 * factor,
        a4=envelope.a4 * factor,
        a7=envelope.a7 * factor,
    )


def _unit_rise(slope: float, phase: float) -> tuple[float, float]:
    """Amplitude and offset with which tanh rises from 0 at -1 to 1 at +1."""
    start, end = np.tanh(phase - slope), np.tanh(phase + slope)
    return float(1 / (end - start)), float(-start / (end - start))


def _maximum(values: FloatArray) -> float:
    """Find the maximum between the points of a grid too: the vertex of a parabola."""
    k = int(np.argmax(values))
    if k in (0, len(values) - 1):
        return float(values[k])
    before, at, after = values[k - 1 : k + 2]
    bend = before - 2 * at + after
    return float(at if bend >= 0 else at - (after - before) ** 2 / (8 * bend))
