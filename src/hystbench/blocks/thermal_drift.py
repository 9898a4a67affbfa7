"""Block ``thermal-drift``: Joule heat expands the rod."""

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.linear import respond
from hystbench.blocks.parameter import number
from hystbench.blocks.state_space import discretise, lag
from hystbench.blocks.step import Sampling, Step
from hystbench.record import FloatArray


class ThermalDrift(Block, name="thermal-drift", place="mechanics"):
    """Expansion by the heat of the input: ``y = z + coefficient LP[u^2]``.

    LP is a first-order low-pass that starts cold: what the heat is made in and what
    expands are one body. With ``second_time_constant_s`` two low-passes follow each
    other: the coil warms and then the rod. ``u^2`` moves straight between samples.

    References
    ----------
    .. [1] G. Engdahl (ed.), Handbook of Giant Magnetostrictive Materials, Academic
       Press, 2000: losses and the heating of rod and coil.
    """

    coefficient: float = number("Y/U^2", "expansion at a steady input")
    time_constant_s: float = number("s", "tau of the warming", 1e-6, 1e6)
    second_time_constant_s: float = number(
        "s", "tau of what is warmed in turn; 0 for none", 0.0, 1e6, default=0.0
    )

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Add the expansion."""
        heat = respond(lag(self.time_constant_s), u * u, dt, "linear")
        if self.second_time_constant_s > 0:
            heat = respond(lag(self.second_time_constant_s), heat, dt, "linear")
        return z + self.coefficient * heat

    def step(self, sampling: Sampling) -> Step:
        """Let the heat go through one low-pass, or two."""
        seconds = [self.time_constant_s, self.second_time_constant_s]
        lags = [
            np.array(discretise(lag(tau), sampling.dt, "linear")).ravel()
            for tau in seconds
            if tau > 0
        ]
        constants = {
            "coefficient": self.coefficient,
            "count": len(lags),
            "lags": np.concatenate(lags),
            "points": 1 + sampling.late,
        }
        count = len(lags)
        states = {"history": 2 + sampling.late, "started": 1}
        states |= {"before": count, "x": count}
        return Step("thermal_drift", constants, states, watches=True)
