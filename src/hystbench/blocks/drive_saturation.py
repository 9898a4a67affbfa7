"""Block ``drive-saturation``: the amplifier runs out of current."""

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import TINY, number
from hystbench.record import FloatArray


class DriveSaturation(Block, name="drive-saturation", place="drive", curve="clip"):
    """Hard limit of the drive: ``v = clip(z, -limit, limit)``.

    References
    ----------
    .. [1] K. J. Astrom, R. M. Murray, Feedback Systems, 2nd ed., Princeton University
       Press, 2021: saturation, rate limits and dead zones of actuators.
    """

    limit: float = number("U", "largest magnitude of its output", TINY)

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Clip the current."""
        return np.clip(z, -self.limit, self.limit)
