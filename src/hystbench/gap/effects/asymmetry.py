"""``asymmetry``: positive and negative halves differ."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.blocks import registry
from hystbench.blocks.base import Block
from hystbench.gap.effects.base import Effect, Values, Variant
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
        if scene.hysteresis is not None:
            start = scene.hysteresis
            rest = scene.chain[start:]

            def build(given: Values) -> tuple[Block, ...]:
                offset = given["offset"]
                return (
                    registry()["gain"].from_mapping({"value": 1.0, "offset": offset}),
                    *rest,
                )

            yield Variant(
                self.name,
                self.place,
                "bias",
                start,
                build,
                0,
                unit={"offset": 1e-3 * scene.largest(start)},
                free=("offset",),
            )
