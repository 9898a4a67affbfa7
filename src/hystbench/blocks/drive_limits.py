"""Block ``drive-limits``: the drive ends at one level above and at another below."""

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import HUGE, number
from hystbench.errors import InputError
from hystbench.record import FloatArray


class DriveLimits(Block, name="drive-limits", place="drive", curve="between"):
    """Hard limits of the drive: ``v = clip(z, lower, upper)``.

    A drive of one sign, as a heater or a single valve, has the lower limit zero. There
    is none where it is left out.

    References
    ----------
    .. [1] K. J. Astrom, R. M. Murray, Feedback Systems, 2nd ed., Princeton University
       Press, 2021: saturation, rate limits and dead zones of actuators.
    """

    upper: float = number("U", "largest output", default=HUGE)
    lower: float = number("U", "smallest output", default=-HUGE)

    def check(self) -> None:
        """Refuse limits that leave nothing between them."""
        if self.lower >= self.upper:
            raise InputError(
                f"lower: {self.lower:g}; expected less than upper, {self.upper:g}"
            )

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Clip the drive."""
        return np.clip(z, self.lower, self.upper)
