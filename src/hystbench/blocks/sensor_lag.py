"""Block ``sensor-lag``: the sensor's electronics lag behind."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.parameter import number
from hystbench.blocks.state_space import StateSpace, lag


@dataclass(frozen=True)
class SensorLag(LinearBlock):
    """First-order low-pass of a sensor: ``Y(s) = Z(s) / (1 + s tau)``.

    References
    ----------
    .. [1] A. J. Fleming, "A review of nanometer resolution position sensors",
       Sensors and Actuators A 190 (2013) 106-126: bandwidth of sensors.
    """

    name: ClassVar = "sensor-lag"
    place: ClassVar = "sensor"

    time_constant_s: float = number("s", "tau", 1e-7, 1e3)

    def continuous(self) -> StateSpace:
        """Return the lag with its output as the state."""
        return lag(self.time_constant_s)
