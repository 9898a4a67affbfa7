"""``thermal-drift``: Joule heat expands the rod."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.gap.effects.base import Effect, Variant, logarithmic
from hystbench.gap.scene import Scene


class ThermalDrift(Effect):
    """Displacement that follows the input's square, slowly."""

    name = "thermal-drift"
    place = "mechanics"

    def variants(self, scene: Scene) -> Iterator[Variant]:
        """Offer it behind the mechanics, by its time constant."""
        end = scene.behind_mechanics
        small = 1e-3 * scene.largest(end) / scene.largest(0) ** 2
        yield self.inserted(
            scene,
            end,
            grids={
                "time_constant_s": logarithmic(scene.span / 200, 3 * scene.span, 2.5)
            },
            unit={"coefficient": small},
        )
