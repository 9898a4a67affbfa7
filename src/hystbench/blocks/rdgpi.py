"""Block ``rdgpi``: rate-dependent generalized Prandtl-Ishlinskii hysteresis."""

from dataclasses import asdict
from typing import Any

import numpy as np

from hystbench.blocks.curve import CENTRAL, about_sample
from hystbench.blocks.parameter import choice, number
from hystbench.blocks.step import PASSED, Sampling, Step, foretold
from hystbench.blocks.wrapping import HystereticBlock
from hystbench.rdgpi.model import STARTS, RateDependentGPI
from hystbench.record import FloatArray


class RateDependentPrandtlIshlinskii(HystereticBlock, name="rdgpi", place="base"):
    """The paper's baseline of Table 4, as :mod:`hystbench.rdgpi` reads it.

    The rate is a central difference, so the output follows its input one sample
    ahead of what a causal block could do.

    References
    ----------
    .. [1] M. Al Janaideh, C.-Y. Su, S. Rakheja, "Development of the rate-dependent
       Prandtl-Ishlinskii model for smart actuators", Smart Materials and Structures
       17 (2008) 035026: the family; docs/rdgpi.md on this member of it.
    """

    alpha1: float = number("-", "scale of the thresholds' spacing", -1e3, 1e3)
    beta1: float = number("-", "spacing at rest, inside the logarithm", 1.0, 1e3)
    lambda1: float = number("s/U", "growth of the spacing with the rate", 0.0)
    alpha2: float = number("-", "loss of weight with the rate", -1e3, 1e3)
    beta2: float = number("-", "weight at rest, inside the logarithm", 1e-9, 1e3)
    lambda2: float = number("s/U", "growth of the loss with the rate", 0.0)
    c: float = number("U", "second scale of the thresholds' spacing")
    rho: float = number("Y/U", "weight of the first operator times N + 1")
    tau: float = number("1/U", "decay of the weights over the thresholds")
    envelope_gain: float = number("-", "the paper's xi", -1e6, 1e6)
    envelope_offset: float = number("U", "the paper's mu")
    order: float = number(
        "-", "N, one less than the operators", 0, 1000, 30.0, whole=True
    )
    start: str = choice("operators before the first sample", STARTS, "rest")

    def check(self) -> None:
        """Refuse what the model itself refuses."""
        self._model()

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the model's output for ``z``."""
        return self._model().simulate(z, dt)

    def _model(self) -> RateDependentGPI:
        values: dict[str, Any] = asdict(self)
        return RateDependentGPI(**values | {"order": int(self.order)})

    def step(self, sampling: Sampling) -> Step:
        """Take the rate from the curve through the input's newest samples."""
        count = int(self.order) + 1
        points, ahead = sampling.curve_points, sampling.ahead
        constants = {
            "spacing": np.array([self.c * self.alpha1, self.beta1, self.lambda1]),
            "loss": np.array([self.alpha2, self.beta2, self.lambda2]),
            "weight": self.rho / count,
            **self.constants("tau", "envelope_gain", "envelope_offset"),
            "points": points,
            "ahead": ahead,
            "rate": about_sample(CENTRAL, points, ahead) / sampling.dt,
            "count": count,
        }
        states = {"history": 1 + points, "w": count}
        return Step(
            "rdgpi",
            constants,
            states,
            gains=1,
            rates=1,
            past=PASSED if self.start == "settled" else "",
            differs=foretold(CENTRAL, points, ahead),
        )
