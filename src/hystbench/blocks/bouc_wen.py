"""Block ``bouc-wen``: Bouc and Wen's hysteresis beside a linear path."""

import numpy as np

from hystbench.blocks.force import against
from hystbench.blocks.hysteretic_force import HystereticForce
from hystbench.blocks.parameter import TINY, number
from hystbench.blocks.step import Sampling, Step
from hystbench.blocks.wrapping import HystereticBlock
from hystbench.record import FloatArray


class BoucWen(HystereticBlock, name="bouc-wen", place="material"):
    """Bouc and Wen's hysteresis beside the signal itself: ``y = z + weight h[z]``.

    ``dh/dz = 1 - |h| / yield_distance (sharing + (1 - sharing) sgn(h dz))``, so that h
    moves as z does near rest and stays within the yield distance. The weight may have
    any sign: a negative one makes a loop that runs the other way. A sharing of zero is
    Dahl's hysteresis; with one there is no loop. It starts with h = 0 at z = 0.
    Rate-independent, of exponent one, solved exactly between two samples as a
    ``hysteretic-force`` is.

    References
    ----------
    .. [1] Y.-K. Wen, "Method for random vibration of hysteretic systems", Journal of
       the Engineering Mechanics Division 102 (1976) 249-263.
    .. [2] F. Ikhouane, J. Rodellar, Systems with Hysteresis: Analysis, Identification
       and Control Using the Bouc-Wen Model, Wiley, 2007.
    """

    weight: float = number("-", "slope of h in the output, near rest")
    yield_distance: float = number("U", "way in which h yields", TINY)
    sharing: float = number(
        "-",
        "0: Dahl's; 0.5: unloads as steep as at rest; 1: unloads as it loads",
        0.0,
        1.0,
        0.5,
    )

    @property
    def law(self) -> HystereticForce:
        """The force with a stiffness of one that follows the signal as h does."""
        return HystereticForce(
            largest=self.yield_distance,
            yield_distance=self.yield_distance,
            sharing=self.sharing,
        )

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Add the operator, which moves along the way from zero on."""
        way = np.concatenate([[0.0], z])
        beside = against((self.law,), way, np.zeros(len(way)), dt)[1:]
        y: FloatArray = z + self.weight * beside
        return y

    def step(self, sampling: Sampling) -> Step:
        """Move along the way from the sample before."""
        _, softens, stiffens, _ = self.law.numbers()
        constants = {"weight": self.weight, "softens": softens, "stiffens": stiffens}
        return Step("bouc_wen_beside", constants, {"before": 1, "h": 1})
