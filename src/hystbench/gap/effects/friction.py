"""``friction``: a force that opposes the direction of motion."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.gap.effects.base import Effect, Variant, logarithmic
from hystbench.gap.scene import Scene


class Friction(Effect):
    """Smooth Coulomb friction of what moves."""

    name = "friction"
    place = "mechanics"

    def variants(self, scene: Scene) -> Iterator[Variant]:
        """Offer it behind the mechanics, by the velocity at which it saturates."""
        end = scene.behind_mechanics
        yield self.inserted(
            scene,
            end,
            grids={
                "velocity_scale": logarithmic(
                    1e-4 * scene.fastest(), scene.fastest() / 5, 2
                )
            },
            inside=("velocity_scale",),
            unit={"coulomb": 1e-3 * scene.largest(end)},
        )
