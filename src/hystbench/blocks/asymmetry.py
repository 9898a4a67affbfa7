"""Block ``asymmetry``: positive and negative halves differ."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import HUGE, number
from hystbench.blocks.step import Sampling, Step, polynomial
from hystbench.record import FloatArray


@dataclass(frozen=True)
class Asymmetry(Block):
    """Even-order part of magnetostriction: ``y = z + coefficient z^2``.

    References
    ----------
    .. [1] G. Engdahl (ed.), Handbook of Giant Magnetostrictive Materials, Academic
       Press, 2000: strain follows the square of the magnetisation.
    """

    name: ClassVar = "asymmetry"
    place: ClassVar = "material"
    reference: ClassVar = "Engdahl, Handbook of Giant Magnetostrictive Materials, 2000"

    coefficient: float = number("1/Y", "weight of the square", -HUGE, HUGE)

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the polynomial."""
        return z * (1.0 + self.coefficient * z)

    def step(self, sampling: Sampling) -> Step:
        """Give the polynomial."""
        return polynomial(0.0, 1.0, self.coefficient)
