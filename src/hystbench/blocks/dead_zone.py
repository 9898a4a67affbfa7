"""Block ``dead-zone``: small commands do nothing."""

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import number
from hystbench.record import FloatArray


class DeadZone(Block, name="dead-zone", place="drive", curve="dead_zone"):
    """Zero between ``-half_width`` and ``half_width``, straight and shifted outside.

    ``v = z - clip(z, -half_width, half_width)``.

    References
    ----------
    .. [1] K. J. Astrom, R. M. Murray, Feedback Systems, 2nd ed., Princeton University
       Press, 2021: saturation, rate limits and dead zones of actuators.
    """

    half_width: float = number("U", "command at which motion starts", 0.0)

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Take off the dead zone."""
        return z - np.clip(z, -self.half_width, self.half_width)
