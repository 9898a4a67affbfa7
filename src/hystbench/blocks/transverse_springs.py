"""Block ``transverse-springs``: springs across the motion, which stiffen it."""

from hystbench.blocks.force import Force, less_stiff
from hystbench.blocks.parameter import TINY, number
from hystbench.record import FloatArray


class TransverseSprings(Force, name="transverse-springs", law="saturating"):
    """Springs across the motion, ``F = stiffness q (1 - 1 / sqrt(1 + (q / reach)^2))``.

    They turn as the coordinate moves: it meets nothing of them near rest, a cube first,
    and far beyond the reach their whole stiffness. The reach is their length at rest.
    Where they are strained there, that part is linear and belongs to the host.

    References
    ----------
    .. [1] I. Kovacic, M. J. Brennan (eds.), The Duffing Equation, Wiley, 2011,
       chapter 2.
    """

    stiffness: float = number("U/Q", "of the springs, far beyond the reach", 0.0)
    reach: float = number("Q", "length of the springs at rest", TINY)

    def numbers(self) -> tuple[float, ...]:
        """Give a spring that levels off, as much as it holds back of a linear one."""
        return (-self.stiffness, self.reach)

    def rows(self) -> FloatArray:
        """Give the linear spring, and the one that levels off taken from it."""
        return less_stiff(super().rows(), -self.stiffness)
