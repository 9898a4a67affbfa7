"""Block ``sensor-lag``: the sensor's electronics lag behind."""

from hystbench.blocks.drive_lag import DriveLag


class SensorLag(DriveLag, name="sensor-lag", place="sensor"):
    """Low-pass of a sensor, as of a filter against aliasing or of a demodulator.

    Of first or second order, as ``drive-lag`` is.

    References
    ----------
    .. [1] A. J. Fleming, "A review of nanometer resolution position sensors",
       Sensors and Actuators A 190 (2013) 106-126: bandwidth of sensors.
    """
