"""Block ``backlash``: play at the output joint."""

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import number
from hystbench.blocks.step import Sampling, Step
from hystbench.operators import play
from hystbench.record import FloatArray


class Backlash(Block, name="backlash", place="mechanics"):
    """Play operator of the output: it moves when the gap is used up (Eqs. 1 and 2).

    The joint starts in the middle of its gap.

    References
    ----------
    .. [1] M. A. Krasnosel'skii, A. V. Pokrovskii, Systems with Hysteresis, Springer,
       1989.
    """

    half_width: float = number("Y", "half of the gap", 0.0)

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Follow the input at the edges of the gap."""
        return play(z, [self.half_width], z[:1])[:, 0]

    def step(self, sampling: Sampling) -> Step:
        """Give the play operator that starts at its first sample."""
        states = {"started": 1, "w": 1}
        return Step("backlash", self.constants("half_width"), states)
