"""``dead-zone``: a small input does nothing."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.gap.effects.base import Effect, Variant, logarithmic
from hystbench.gap.scene import Scene


class DeadZone(Effect):
    """A dead zone of up to half of the largest input."""

    name = "dead-zone"
    place = "drive"

    def variants(self, scene: Scene) -> Iterator[Variant]:
        """Offer the dead zone before the first block."""
        largest = scene.largest(0)
        yield self.inserted(
            scene,
            0,
            grids={"half_width": logarithmic(1e-3 * largest, 0.5 * largest, 4)},
        )
