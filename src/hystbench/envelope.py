"""Envelope functions of the generalized play operator, and the thresholds they give.

Equation numbers are those of Zhang and Ma, "Modeling of Rate-Dependent Hysteresis
Using a GPO-Based Adaptive Filter".
"""

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from hystbench import kernels
from hystbench.errors import InputError
from hystbench.record import FloatArray


class NamedNumbers:
    """Mixin of a dataclass of numbers: all finite, and given by name."""

    place: ClassVar[str]
    """What messages call it."""

    def check_finite(self) -> None:
        """Refuse numbers that are not finite."""
        # asdict would copy: this runs a thousand times in a fit
        for name, value in vars(self).items():
            if not isinstance(value, str) and not math.isfinite(value):
                raise InputError(f"{self.place}.{name}: {value} is not a finite number")

    def to_dict(self) -> dict[str, Any]:
        """Give the parameters by name."""
        return dict(vars(self))


@dataclass(frozen=True)
class Envelope(NamedNumbers):
    """Envelope functions of the generalized play operator, Eqs. 5 and 6.

    The left one, ``a0 tanh(a1 v + a2) + a3``, bounds the output from above where
    the input falls; the right one, ``a4 tanh(a5 v + a6) + a7``, from below where it
    rises.

    Parameters
    ----------
    a0, a1, a2, a3 : float
        Left envelope; ``a0`` and ``a3`` in the unit of the output, ``a1`` in 1 per
        unit of the input.
    a4, a5, a6, a7 : float
        Right envelope, likewise.

    Raises
    ------
    InputError
        If a parameter is not finite.
    """

    place: ClassVar[str] = "envelope"

    a0: float
    a1: float
    a2: float
    a3: float
    a4: float
    a5: float
    a6: float
    a7: float

    def __post_init__(self) -> None:
        """Refuse parameters that are not finite."""
        self.check_finite()

    def left(self, v: ArrayLike) -> FloatArray:
        """Left envelope, Eq. 5, at each input."""
        return _curve(self.a0, self.a1, self.a2, self.a3, v)

    def right(self, v: ArrayLike) -> FloatArray:
        """Right envelope, Eq. 6, at each input."""
        return _curve(self.a4, self.a5, self.a6, self.a7, v)


PUBLISHED_ENVELOPE = Envelope(
    a0=1.2878,
    a1=0.36,
    a2=0.6025,
    a3=-0.6671,
    a4=0.3223,
    a5=1.2233,
    a6=0.1104,
    a7=-0.0248,
)
"""What the paper identified at 1 Hz, input in amperes (section 4)."""


def thresholds(envelope: Envelope, amplitude: float, order: int) -> FloatArray:
    """Thresholds of the generalized play operators, Eq. 10.

    Parameters
    ----------
    envelope : Envelope
        Envelope functions.
    amplitude : float
        Largest magnitude of the input.
    order : int
        Order N.

    Returns
    -------
    ndarray, shape (order + 1,)
        ``i / (N + 1) * max(right(amplitude), left(amplitude))``, i from 0 to N.
    """
    largest = max(float(envelope.right(amplitude)), float(envelope.left(amplitude)))
    return equal_intervals(largest, order)


def equal_intervals(largest: float, order: int) -> FloatArray:
    """Thresholds of plays, Eq. 10: ``i / (N + 1) * largest``, i from 0 to N."""
    if order < 0:
        raise InputError(f"order: {order} given, 0 or more expected")
    if not 0 < largest < np.inf:
        raise InputError(f"thresholds: the largest would be {largest}; check amplitude")
    return np.arange(order + 1) / (order + 1) * largest


def fewest_samples(order: int) -> int:
    """Count the samples that N + 1 weights and an envelope's 8 parameters need.

    Twice the weights, so that a filter sees each more than once, and 8 more.
    """
    return 2 * (order + 1) + 8


def _curve(
    height: float, slope: float, place: float, offset: float, v: ArrayLike
) -> FloatArray:
    x: FloatArray = np.ascontiguousarray(v, dtype=np.float64).reshape(np.shape(v))
    curve: FloatArray = np.empty(x.shape)
    kernels.call("hb_envelope", x.size, height, slope, place, offset, x, curve)
    return curve
