"""``drag``: a force that grows with the velocity squared."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.blocks.drag import Drag as DragBlock
from hystbench.gap.effects.effect import ForceEffect
from hystbench.gap.effects.law import Law, Moved


class Drag(ForceEffect):
    """Drag of a fluid in turbulent flow."""

    name = "drag"
    shows = "rate"

    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Offer it weak."""
        block = DragBlock(coefficient=0.03 * moved.force / moved.speed**2)
        yield Law("", block, ("coefficient",))
