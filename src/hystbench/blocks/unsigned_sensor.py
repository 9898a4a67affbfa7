"""Block ``unsigned-sensor``: a sensor that does not show the sign."""

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import TINY, number
from hystbench.record import FloatArray


class UnsignedSensor(Block, name="unsigned-sensor", place="sensor", curve="magnitude"):
    """Magnitude of the true output, ``y = scale |z|``: pulses are counted either way.

    References
    ----------
    .. [1] T. Wigren, M. Schoukens, "Coupled electric drives data set and reference
       models", Department of Information Technology, Uppsala University, report
       2017-024: pulse counters that do not tell the direction of turning.
    """

    scale: float = number("-", "of what is shown", TINY)

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Leave the sign out."""
        return self.scale * np.abs(z)
