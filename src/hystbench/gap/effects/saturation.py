"""``saturation``: the material gives less the more it gives."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hystbench.gap.effects.base import Effect, Variant, logarithmic, places_inside
from hystbench.gap.scene import Scene

SHARPEST = 50.0
"""Beyond it, a corner is a corner."""


class Saturation(Effect):
    """An odd, soft limit behind the hysteresis, of one sharpness or another."""

    name = "saturation"
    place = "material"

    def variants(self, scene: Scene) -> Iterator[Variant]:
        """Offer levels from half to thirty times the largest signal there."""
        for place in (scene.behind_hysteresis, *places_inside(scene)):
            yield from self._at(scene, place)

    def _at(self, scene: Scene, place: int) -> Iterator[Variant]:
        largest = scene.largest(place)
        levels = logarithmic(0.5 * largest, 30 * largest, 5)
        yield self.inserted(scene, place, grids={"level": levels})
        yield self.inserted(
            scene,
            place,
            form="algebraic",
            grids={"level": levels, "sharpness": np.array([2.0, 3.0, 4.5, 8.0])},
            limits={"sharpness": (2.0, SHARPEST)},
        )
