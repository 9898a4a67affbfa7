"""Block ``sensor-nonlinearity``: a sensor whose reading is a curve."""

from hystbench.blocks.base import PolynomialBlock
from hystbench.blocks.parameter import number


class SensorNonlinearity(PolynomialBlock, name="sensor-nonlinearity", place="sensor"):
    """Static polynomial of the true output: ``y = z + quadratic z^2 + cubic z^3``.

    References
    ----------
    .. [1] A. J. Fleming, "A review of nanometer resolution position sensors",
       Sensors and Actuators A 190 (2013) 106-126, on the nonlinearity of
       displacement sensors and its polynomial calibration.
    """

    terms = (0.0, 1.0, "quadratic", "cubic")

    quadratic: float = number("1/Y", "weight of the square")
    cubic: float = number("1/Y^2", "weight of the cube")
