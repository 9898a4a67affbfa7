"""Block ``hysteresis-shape``: what a hysteresis of the wrong shape lacks."""

import numpy as np

from hystbench.blocks.parameter import a_threshold, numbers
from hystbench.blocks.step import Sampling, Step
from hystbench.blocks.wrapping import Growth, Wrappable, WrappingBlock
from hystbench.operators import growing_play
from hystbench.record import FloatArray


class HysteresisShape(WrappingBlock, name="hysteresis-shape", place="material"):
    """Rate-independent correction beside the hysteresis that it wraps.

    ``y = inner[v] + sum_k c_k v^k + sum_i (w_i P_i + s_i P_i^2)`` with v what enters
    the hysteresis and P_i the play operator of threshold r_i on v (paper, Eqs. 1
    and 2, w(0) = 0). It is linear in ``powers`` c, ``weights`` w and
    ``square_weights`` s. The plays are symmetric, their squares are not: together
    they reshape minor loops, corners and the difference of both halves.

    References
    ----------
    .. [1] K. Kuhnen, "Modeling, identification and compensation of complex hysteretic
       nonlinearities: a modified Prandtl-Ishlinskii approach", European Journal of
       Control 9 (2003) 407-418.
    """

    thresholds: tuple[float, ...] = numbers("U", "r_i of the play operators", 0.0)
    weights: tuple[float, ...] = a_threshold("Y/U", "w_i", optional=False)
    square_weights: tuple[float, ...] = a_threshold("Y/U^2", "s_i")
    powers: tuple[float, ...] = numbers("Y/U^k", "c_k, from k = 1 on", optional=True)

    @property
    def count(self) -> int:
        """How many play operators there are."""
        return len(self.thresholds)

    def wrap(
        self, inner: Wrappable, v: FloatArray, u: FloatArray, dt: float, growth: Growth
    ) -> FloatArray:
        """Add the correction, whose thresholds grow with those inside."""
        weights = np.array([self.weights, self.square_weights or [0.0] * self.count])
        used = weights.any(axis=0)  # mostly one alone, while its weight is looked for
        plays = growing_play(v, np.array(self.thresholds)[used], growth)
        y: FloatArray = inner.grow(v, u, dt, growth) + plays @ weights[0, used]
        if weights[1].any():
            y += (plays * plays) @ weights[1, used]
        if any(self.powers):
            y += v * np.polyval(self.powers[::-1], v)
        return y

    def step(self, sampling: Sampling) -> Step:
        """Give what is added to the hysteresis inside."""
        constants = {
            "count": self.count,
            "thresholds": np.array(self.thresholds),
            "weights": np.array(self.weights),
            "square_weights": np.array(self.square_weights or (0.0,) * self.count),
            "degrees": 1 + len(self.powers),
            "powers": np.array((0.0, *self.powers)),
        }
        return Step("hysteresis_shape", constants, {"w": self.count}, grows=True)
