"""``asymmetry``: positive and negative halves differ."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar

from hystbench.blocks import registry
from hystbench.blocks.base import Block
from hystbench.gap.effects.base import Effect, Values, Variant, places_inside
from hystbench.gap.scene import Scene


class Asymmetry(Effect):
    """A square behind the hysteresis, or a field bias before it."""

    name = "asymmetry"
    place = "material"
    offsets: ClassVar = {"bias": (("bias", "U"), ("zero", "Y"))}

    def variants(self, scene: Scene) -> Iterator[Variant]:
        """Offer the square behind the hysteresis and the bias before it."""
        for place in (scene.behind_hysteresis, *places_inside(scene)):
            unit = {"coefficient": 1e-3 / scene.largest(place)}
            yield self.inserted(scene, place, form="square", unit=unit)
        if scene.hysteresis is not None:
            yield self._bias(scene, scene.hysteresis)

    def _bias(self, scene: Scene, start: int) -> Variant:
        """A constant added to the field; the sensor is set to zero with it on."""
        gain = registry()["gain"]
        behind = scene.behind_hysteresis
        loop, rest = scene.chain[start:behind], scene.chain[behind:]

        def build(given: Values) -> tuple[Block, ...]:
            bias, zero = (
                gain.from_mapping({"value": 1.0, "offset": given[name]})
                for name in ("bias", "zero")
            )
            return (bias, *loop, zero, *rest)

        return Variant(
            self.name,
            self.place,
            "bias",
            start,
            build,
            (0, len(loop) + 1),
            unit={
                "bias": 1e-3 * scene.largest(start),
                "zero": 1e-3 * scene.largest(behind),
            },
            free=("offset",),
        )
