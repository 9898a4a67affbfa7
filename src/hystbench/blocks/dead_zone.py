"""Block ``dead-zone``: small commands do nothing."""

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import number
from hystbench.errors import InputError
from hystbench.record import FloatArray


class DeadZone(Block, name="dead-zone", place="drive", curve="rounded_dead_zone"):
    """Zero between ``-half_width`` and ``half_width``, straight and shifted outside.

    ``v = z - clip(z, -half_width, half_width)``. Or rounded: ``v = z - half_width
    tanh(z / rounding)``, as of two transistors that take over from each other, or of a
    valve that leaks where it should be closed. It gives the less near zero the nearer
    the rounding is to the half width.

    References
    ----------
    .. [1] K. J. Astrom, R. M. Murray, Feedback Systems, 2nd ed., Princeton University
       Press, 2021: saturation, rate limits and dead zones of actuators.
    .. [2] P. Horowitz, W. Hill, The Art of Electronics, 3rd ed., Cambridge University
       Press, 2015: crossover distortion.
    """

    half_width: float = number("U", "command at which motion starts", 0.0)
    rounding: float = number(
        "U", "command by which it is rounded; 0 for corners", 0.0, default=0.0
    )

    def check(self) -> None:
        """Refuse a curve that falls near zero."""
        if 0.0 < self.rounding < self.half_width:
            raise InputError(
                f"rounding: {self.rounding:g}; expected 0 or at least half_width, "
                f"{self.half_width:g}"
            )

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Take off the dead zone."""
        if self.rounding:
            return z - self.half_width * np.tanh(z / self.rounding)
        return z - np.clip(z, -self.half_width, self.half_width)
