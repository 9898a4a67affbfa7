"""Block ``sensor-lag``: the sensor's electronics lag behind."""

import numpy as np

from hystbench.blocks.drive_lag import DriveLag
from hystbench.blocks.parameter import number
from hystbench.blocks.state_space import StateSpace


class SensorLag(DriveLag, name="sensor-lag", place="sensor"):
    """Low-pass of a sensor, of first order: ``Y(s) = Z(s) / (1 + s tau)``.

    With a damping ratio zeta it is of second order, as of a filter against aliasing or
    of a demodulator: ``Y(s) = Z(s) / (1 + 2 zeta s tau + (s tau)^2)``. Zeta is 0.71 of
    Butterworth's filter, 0.87 of Bessel's, and 1 of two equal lags.

    References
    ----------
    .. [1] A. J. Fleming, "A review of nanometer resolution position sensors",
       Sensors and Actuators A 190 (2013) 106-126: bandwidth of sensors.
    """

    damping_ratio: float = number(
        "-", "zeta; 0 for a lag of first order", 0.0, 10.0, default=0.0
    )

    def continuous(self) -> StateSpace:
        """Return the lag with its output, and behind it its scaled rate, as states."""
        if not self.damping_ratio:
            return super().continuous()
        rate = 1.0 / self.time_constant_s
        return StateSpace(
            np.array([[0.0, rate], [-rate, -2.0 * self.damping_ratio * rate]]),
            np.array([0.0, rate]),
            np.array([1.0, 0.0]),
            0.0,
        )
