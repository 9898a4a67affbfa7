"""Block ``sensor-lag``: the sensor's electronics lag behind."""

from __future__ import annotations

from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.parameter import number
from hystbench.blocks.state_space import StateSpace, lag


class SensorLag(LinearBlock, name="sensor-lag", place="sensor"):
    """First-order low-pass of a sensor: ``Y(s) = Z(s) / (1 + s tau)``.

    References
    ----------
    .. [1] A. J. Fleming, "A review of nanometer resolution position sensors",
       Sensors and Actuators A 190 (2013) 106-126: bandwidth of sensors.
    """

    time_constant_s: float = number("s", "tau", 1e-7, 1e3)

    def continuous(self) -> StateSpace:
        """Return the lag with its output as the state."""
        return lag(self.time_constant_s)
