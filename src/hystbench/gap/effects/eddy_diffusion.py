"""``eddy-diffusion``: the field diffuses into a conducting slab or rod."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

from hystbench.gap.effects.base import (
    Effect,
    Values,
    Variant,
    logarithmic,
    places_in_drive,
)
from hystbench.gap.scene import Scene


class EddyDiffusion(Effect):
    """Magnetic diffusion before the material, in a slab or in a rod."""

    name = "eddy-diffusion"
    place = "drive"

    def variants(self, scene: Scene) -> Iterator[Variant]:
        """Offer both shapes of the cross-section, behind the drive's limits as well."""
        times = logarithmic(scene.step / 5, scene.span / 5, 1.5)
        for place in places_in_drive(scene, linear=True):
            for geometry in ("slab", "rod"):
                yield self.inserted(
                    scene,
                    place,
                    partial(_values, geometry),
                    form=geometry,
                    grids={"time_constant_s": times},
                )


def _values(geometry: str, given: Values) -> dict[str, Any]:
    return {**given, "geometry": geometry}
