"""Block ``asymmetry``: positive and negative halves differ."""

from hystbench.blocks.base import PolynomialBlock
from hystbench.blocks.parameter import number


class Asymmetry(PolynomialBlock, name="asymmetry", place="material"):
    """Even-order part of magnetostriction: ``y = z + coefficient z^2``.

    References
    ----------
    .. [1] G. Engdahl (ed.), Handbook of Giant Magnetostrictive Materials, Academic
       Press, 2000: strain follows the square of the magnetisation.
    """

    terms = (0.0, 1.0, "coefficient")

    coefficient: float = number("1/Y", "weight of the square")
