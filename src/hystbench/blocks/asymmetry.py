"""Block ``asymmetry``: positive and negative halves differ."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hystbench.blocks.base import PolynomialBlock
from hystbench.blocks.parameter import HUGE, number


@dataclass(frozen=True)
class Asymmetry(PolynomialBlock):
    """Even-order part of magnetostriction: ``y = z + coefficient z^2``.

    References
    ----------
    .. [1] G. Engdahl (ed.), Handbook of Giant Magnetostrictive Materials, Academic
       Press, 2000: strain follows the square of the magnetisation.
    """

    name: ClassVar = "asymmetry"
    place: ClassVar = "material"

    coefficient: float = number("1/Y", "weight of the square", -HUGE, HUGE)

    @property
    def coefficients(self) -> tuple[float, ...]:
        """Those of the polynomial, the constant first."""
        return 0.0, 1.0, self.coefficient
