"""``input-delay``: the input acts late."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.gap.effects.base import Effect, Law, Moved, Variant, logarithmic
from hystbench.gap.simulation.simulation import Scene


class InputDelay(Effect):
    """A delay before everything else, up to a twentieth of the longest record."""

    name = "input-delay"
    shows = "delay"
    place = "drive"

    def variants(self, scene: Scene) -> Iterator[Variant]:
        """Offer the delay before the first block."""
        yield self.inserted(
            scene,
            0,
            grids={"delay_s": logarithmic(scene.step / 20, scene.span / 20, 2)},
        )

    def inside(self, moved: Moved) -> Iterator[Law]:
        """Offer it before the mechanism."""
        yield self.beside_mechanism(moved, "delay_s", "before")
