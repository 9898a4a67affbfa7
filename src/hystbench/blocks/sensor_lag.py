"""Block ``sensor-lag``: the sensor's electronics lag behind."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hystbench.blocks.linear import LinearBlock, linear_step
from hystbench.blocks.parameter import choice, number
from hystbench.blocks.state_space import StateSpace, lag
from hystbench.blocks.step import Sampling, Step
from hystbench.blocks.transfer_function import path_from
from hystbench.record import FloatArray


@dataclass(frozen=True)
class SensorLag(LinearBlock):
    """First-order low-pass of a sensor: ``Y(s) = Z(s) / (1 + s tau)``.

    With ``start: settled`` its input had its first value for ever before the record.

    References
    ----------
    .. [1] A. J. Fleming, "A review of nanometer resolution position sensors",
       Sensors and Actuators A 190 (2013) 106-126: bandwidth of sensors.
    """

    name: ClassVar = "sensor-lag"
    place: ClassVar = "sensor"

    time_constant_s: float = number("s", "tau", 1e-7, 1e3)

    start: str = choice("state before the first sample", ("rest", "settled"), "rest")

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the response to ``z``."""
        path, before = path_from(z, self.start)
        return super().simulate(path - before, u, dt) + before

    def step(self, sampling: Sampling) -> Step:
        """Move the state over the interval that has passed."""
        settled = self.start != "rest"
        return linear_step(self.continuous(), sampling, self.holding, settled)

    def continuous(self) -> StateSpace:
        """Return the lag with its output as the state."""
        return lag(self.time_constant_s)
