"""Block ``sensor-lag``: the sensor's electronics lag behind."""

from hystbench.blocks.drive_lag import DriveLag


class SensorLag(DriveLag, name="sensor-lag", place="sensor"):
    """First-order low-pass of a sensor: ``Y(s) = Z(s) / (1 + s tau)``.

    References
    ----------
    .. [1] A. J. Fleming, "A review of nanometer resolution position sensors",
       Sensors and Actuators A 190 (2013) 106-126: bandwidth of sensors.
    """
