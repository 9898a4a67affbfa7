"""Block ``calibration-error``: a sensor read with the wrong gain and zero."""

from hystbench.blocks.base import PolynomialBlock
from hystbench.blocks.parameter import number


class CalibrationError(PolynomialBlock, name="calibration-error", place="sensor"):
    """Sensor with gain and zero error: ``y = gain z + offset``.

    References
    ----------
    .. [1] JCGM 200:2012, International vocabulary of metrology (VIM), 4.28.
    """

    terms = ("offset", "gain")

    gain: float = number("-", "ratio of read to true output", 0.1, 10.0)
    offset: float = number("Y", "reading at zero", default=0.0)
