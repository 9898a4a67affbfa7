"""Block ``saturating-stiffness``: a spring in a mechanism whose force levels off."""

from hystbench.blocks.force import Force
from hystbench.blocks.parameter import TINY, number


class SaturatingStiffness(Force, name="saturating-stiffness", law="saturating"):
    """A spring that softens, ``F = stiffness q / sqrt(1 + (q / reach)^2)``.

    Far beyond the reach its force is constant, ``stiffness reach``: magnetic springs,
    buckled beams, floats that come out of the water.

    References
    ----------
    .. [1] W. Lacarbonara, Nonlinear Structural Mechanics, Springer, 2013.
    """

    stiffness: float = number("U/Q", "of the spring at q = 0", 0.0)
    reach: float = number("Q", "distance beyond which it levels off", TINY)

    @property
    def slope(self) -> float:
        """Near rest it swings as fast as this says."""
        return self.stiffness
