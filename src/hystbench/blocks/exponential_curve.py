"""Block ``exponential-curve``: each step more gives more, by the same factor."""

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import number
from hystbench.record import FloatArray


class ExponentialCurve(
    Block, name="exponential-curve", place="drive", curve="exponential"
):
    """A diode or a valve of equal percentage: ``y = (exp(c z) - 1) / c``, c curvature.

    A straight line of slope one at zero, and for a curvature of zero throughout. A
    negative curvature gives less and less.

    References
    ----------
    .. [1] W. Shockley, "The theory of p-n junctions in semiconductors and p-n junction
       transistors", Bell System Technical Journal 28 (1949) 435-489.
    .. [2] IEC 60534-2-4, Industrial-process control valves: inherent flow
       characteristics and rangeability, 2009.
    """

    curvature: float = number("1/U", "growth for each unit of the input")

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Bend what enters; infinite where that is beyond numbers."""
        if self.curvature == 0.0:
            return z.copy()
        with np.errstate(over="ignore"):
            return np.asarray(np.expm1(self.curvature * z) / self.curvature)
