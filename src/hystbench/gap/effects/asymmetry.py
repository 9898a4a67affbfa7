"""``asymmetry``: positive and negative halves differ."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.gap.effects.base import Effect, Variant
from hystbench.gap.scene import Scene


class Asymmetry(Effect):
    """A square behind the hysteresis, or a field bias before it."""

    name = "asymmetry"
    place = "material"

    def variants(self, scene: Scene) -> Iterator[Variant]:
        """Offer the square behind the hysteresis and the bias before it."""
        place = scene.behind_hysteresis
        small = 1e-3 / scene.largest(place)
        yield self.inserted(scene, place, form="square", unit={"coefficient": small})
        if False and scene.hysteresis is not None:
            small = 1e-3 * scene.largest(scene.hysteresis)
            yield self.inserted(
                scene,
                place,
                lambda given: {"form": "bias", "coefficient": given["coefficient"]},
                form="bias",
                unit={"coefficient": small},
            )
