"""Block ``gain``: a static straight line."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import HUGE, number
from hystbench.blocks.step import Sampling, Step, polynomial
from hystbench.record import FloatArray


@dataclass(frozen=True)
class Gain(Block):
    """Static gain with an offset: ``y = value z + offset``.

    References
    ----------
    By definition.
    """

    name: ClassVar = "gain"
    place: ClassVar = "base"
    reference: ClassVar = "by definition"

    value: float = number("Y/U", "static gain", -HUGE, HUGE)
    offset: float = number("Y", "output at zero", -HUGE, HUGE, default=0.0)

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the straight line."""
        return self.value * z + self.offset

    def step(self, sampling: Sampling) -> Step:
        """Give the straight line."""
        return polynomial(self.offset, self.value)
