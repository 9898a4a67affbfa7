"""Block ``butterfly``: strain that follows the square of a hysteretic field."""

from hystbench.blocks.parameter import number
from hystbench.blocks.step import Sampling, Step
from hystbench.blocks.wrapping import Growth, Wrappable, WrappingBlock
from hystbench.operators import growing_play
from hystbench.record import FloatArray


class Butterfly(WrappingBlock, name="butterfly", place="material"):
    """Even-order part of the strain beside the hysteresis that it wraps.

    ``y = inner[v] + coefficient P[v]^2`` with v what enters the hysteresis and P the
    play operator of one threshold on v (paper, Eqs. 1 and 2, w(0) = 0). An even map of
    a simple loop makes a butterfly [1]_; strain follows the square of the
    magnetisation, which lags behind the field [2]_.

    References
    ----------
    .. [1] B. Drincic, X. Tan, D. S. Bernstein, "Why are some hysteresis loops shaped
       like a butterfly?", Automatica 47 (2011) 2658-2664.
    .. [2] G. Engdahl (ed.), Handbook of Giant Magnetostrictive Materials, Academic
       Press, 2000.
    """

    coefficient: float = number("Y/U^2", "weight of the square")
    threshold: float = number("U", "half the width of the play", 0.0)

    def wrap(
        self, inner: Wrappable, v: FloatArray, u: FloatArray, dt: float, growth: Growth
    ) -> FloatArray:
        """Add the square, whose threshold grows with those inside."""
        moved = growing_play(v, [self.threshold], growth)
        return inner.grow(v, u, dt, growth) + self.coefficient * moved[:, 0] ** 2

    def step(self, sampling: Sampling) -> Step:
        """Give what is added to the hysteresis inside."""
        constants = self.constants("coefficient", "threshold")
        return Step("butterfly", constants, {"w": 1}, grows=True)
