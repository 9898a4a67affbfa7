"""Block ``slew-limit``: the drive changes no faster than its rate."""

import numpy as np

from hystbench import kernels
from hystbench.blocks.base import Block
from hystbench.blocks.parameter import TINY, number
from hystbench.blocks.step import Sampling, Step
from hystbench.record import FloatArray


class SlewLimit(Block, name="slew-limit", place="drive"):
    """Output that follows its input with ``|dv/dt| <= rate``.

    It starts at the input's first sample. Exact for an input that moves straight
    between samples: where the output catches up within an interval, it follows from
    there on.

    References
    ----------
    .. [1] K. J. Astrom, R. M. Murray, Feedback Systems, 2nd ed., Princeton University
       Press, 2021: saturation, rate limits and dead zones of actuators.
    """

    rate: float = number("U/s", "largest rate of the output", TINY)

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Follow the input at a limited rate."""
        v = np.empty(len(z))
        rate = self.rate * dt
        z = np.ascontiguousarray(z, np.float64)
        kernels.call("hb_slew_limit", len(z), rate, z, v)
        return v

    def step(self, sampling: Sampling) -> Step:
        """Follow the input, which goes straight from its last sample."""
        states = {"started": 1, "before": 1, "now": 1}
        return Step("slew_limit", {"rate": self.rate * sampling.dt}, states)
