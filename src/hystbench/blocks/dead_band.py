"""Block ``dead-band``: a dead zone with one edge above and another one below."""

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import number
from hystbench.errors import InputError
from hystbench.record import FloatArray


class DeadBand(Block, name="dead-band", place="drive", curve="dead_band"):
    """Command that must exceed an edge: ``v = z - clip(z, lower, upper)``.

    A valve whose spool overlaps more on one side, or a motor that starts at another
    voltage each way, has edges of two sizes.

    References
    ----------
    .. [1] H. E. Merritt, Hydraulic Control Systems, Wiley, 1967: overlap of a spool.
    """

    upper: float = number("U", "command at which motion starts upwards", 0.0)
    lower: float = number("U", "command at which it starts downwards; 0 or less")

    def check(self) -> None:
        """Refuse a band without zero in it."""
        if self.lower > 0.0:
            raise InputError(f"lower: {self.lower:g}; expected 0 or less")

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Take off the band."""
        return z - np.clip(z, self.lower, self.upper)
