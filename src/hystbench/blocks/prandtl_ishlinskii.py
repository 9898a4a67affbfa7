"""Block ``prandtl-ishlinskii``: play operators beside a linear path."""

import numpy as np

from hystbench.blocks.parameter import a_threshold, numbers
from hystbench.blocks.step import Sampling, Step
from hystbench.blocks.wrapping import Growth, PlayBlock
from hystbench.operators import growing_play
from hystbench.record import FloatArray


class PrandtlIshlinskii(PlayBlock, name="prandtl-ishlinskii", place="material"):
    """Play operators beside the signal itself: ``y = z + sum_i w_i P_i[z]``.

    ``P_i`` is the play operator of threshold r_i (paper, Eqs. 1 and 2, w(0) = 0). The
    weights may have any sign: negative ones make a loop that runs the other way, and
    only their sum is the loop's mean slope. ``square_weights`` s and ``cube_weights`` c
    bend the branches, ``+ sum_i (s_i P_i[z]^2 + c_i P_i[z]^3)``: the squares of both
    halves differ, the cubes are odd as the plays are.

    References
    ----------
    .. [1] M. Brokate, J. Sprekels, Hysteresis and Phase Transitions, Springer, 1996,
       Section 2.4.
    .. [2] K. Kuhnen, "Modeling, identification and compensation of complex hysteretic
       nonlinearities: a modified Prandtl-Ishlinskii approach", European Journal of
       Control 9 (2003) 407-418.
    """

    thresholds: tuple[float, ...] = numbers("U", "r_i of the play operators", 0.0)
    weights: tuple[float, ...] = a_threshold("-", "w_i", optional=False)
    square_weights: tuple[float, ...] = a_threshold("1/U", "s_i")
    cube_weights: tuple[float, ...] = a_threshold("1/U^2", "c_i")

    def grow(
        self, v: FloatArray, u: FloatArray, dt: float, growth: Growth
    ) -> FloatArray:
        """Add the weighted plays with all thresholds times ``growth``."""
        plays = growing_play(v, self.thresholds, growth)
        y: FloatArray = v + plays @ np.array(self.weights)
        if self.square_weights:
            y += plays**2 @ np.array(self.square_weights)
        if self.cube_weights:
            y += plays**3 @ np.array(self.cube_weights)
        return y

    def step(self, sampling: Sampling) -> Step:
        """Add the weighted plays."""
        none = (0.0,) * len(self.thresholds)
        constants = {
            "count": len(self.weights),
            "thresholds": np.array(self.thresholds),
            "weights": np.array(self.weights),
            "square_weights": np.array(self.square_weights or none),
            "cube_weights": np.array(self.cube_weights or none),
        }
        states = {"w": len(self.weights)}
        return Step("prandtl_ishlinskii", constants, states, grows=True)
