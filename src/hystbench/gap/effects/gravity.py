"""``gravity``: the moment of a weight that turns."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.blocks.gravity import Gravity as GravityBlock
from hystbench.gap.effects.base import ForceEffect, Law, Moved


class Gravity(ForceEffect):
    """A pendulum."""

    name = "gravity"

    def inside(self, moved: Moved) -> Iterator[Law]:
        """Offer it of either sign, where the coordinate is an angle."""
        for sign in (1.0, -1.0) if moved.turns and not moved.anywhere else ():
            block = GravityBlock(amplitude=sign * 0.1 * moved.force)
            yield Law("", block, ("amplitude", "angle"))
