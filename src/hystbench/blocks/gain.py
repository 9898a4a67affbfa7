"""Block ``gain``: a static straight line."""

from hystbench.blocks.base import PolynomialBlock
from hystbench.blocks.parameter import number


class Gain(PolynomialBlock, name="gain", place="base"):
    """Static gain with an offset: ``y = value z + offset``.

    References
    ----------
    By definition.
    """

    terms = ("offset", "value")

    value: float = number("Y/U", "static gain")
    offset: float = number("Y", "output at zero", default=0.0)
