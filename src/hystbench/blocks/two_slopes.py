"""Block ``two-slopes``: one way gives more than the other."""

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import number
from hystbench.record import FloatArray


class TwoSlopes(Block, name="two-slopes", place="drive", curve="two_slopes"):
    """A cylinder with a rod on one side: ``y = z + difference |z|``.

    Its slope is ``1 + difference`` above zero and ``1 - difference`` below.

    References
    ----------
    .. [1] H. E. Merritt, Hydraulic Control Systems, Wiley, 1967: the areas of a
       single-rod cylinder.
    """

    difference: float = number(
        "-", "by which one slope is more than one, and the other less", -1, 1
    )

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Give more one way than the other."""
        return np.asarray(z + self.difference * np.abs(z))
