"""``asymmetry``: positive and negative halves differ."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar

from hystbench.blocks import registry
from hystbench.blocks.base import Block
from hystbench.gap.effects.base import (
    Effect,
    Values,
    Variant,
    logarithmic,
    places_inside,
)
from hystbench.gap.simulation.simulation import Scene


class Asymmetry(Effect):
    """An even term behind the hysteresis, before it or beside it, or a field bias."""

    name = "asymmetry"
    shows = "amplitude"
    place = "material"
    offsets: ClassVar = {"bias": (("bias", "U"), ("zero", "Y"))}
    laws: ClassVar = ("butterfly",)

    def variants(self, scene: Scene) -> Iterator[Variant]:
        """Offer the square behind the hysteresis, and three laws of the field.

        The field has a square of its own (a magnetic circuit about its working point),
        a constant bias, or the square of it that lags (a butterfly).
        """
        for place in (scene.behind_hysteresis, *places_inside(scene)):
            yield self._square(scene, place, "square")
        if scene.hysteresis is not None:
            yield self._bias(scene, scene.hysteresis)
            yield self._square(scene, scene.hysteresis, "square of the field")
            yield self._butterfly(scene, scene.hysteresis)

    def _square(self, scene: Scene, place: int, form: str) -> Variant:
        unit = {"coefficient": 1e-3 / scene.largest(place)}
        return self.inserted(scene, place, form=form, unit=unit)

    def _butterfly(self, scene: Scene, start: int) -> Variant:
        """The square of a play operator of the field."""
        amplitude = scene.largest(start)
        size = scene.largest(scene.behind_hysteresis) / amplitude**2
        return self.inserted(
            scene,
            start + 1,
            law="butterfly",
            form="butterfly",
            grids={"threshold": logarithmic(0.02 * amplitude, 0.7 * amplitude, 4)},
            unit={"coefficient": 1e-3 * size},
        )

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
