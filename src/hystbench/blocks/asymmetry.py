"""Block ``asymmetry``: positive and negative halves differ."""

from hystbench.blocks.base import PolynomialBlock
from hystbench.blocks.parameter import number


class Asymmetry(PolynomialBlock, name="asymmetry", place="material"):
    """Even-order part of magnetostriction: ``y = z + coefficient (z - about)^2``.

    A device that operates about a bias has a gain that is told there.

    References
    ----------
    .. [1] G. Engdahl (ed.), Handbook of Giant Magnetostrictive Materials, Academic
       Press, 2000: strain follows the square of the magnetisation.
    """

    coefficient: float = number("1/Y", "weight of the square")
    about: float = number("Y", "where the square adds nothing", default=0.0)

    @property
    def coefficients(self) -> tuple[float, ...]:
        """Those of the polynomial, the constant first."""
        weight, about = self.coefficient, self.about
        return weight * about**2, 1.0 - 2.0 * weight * about, weight
