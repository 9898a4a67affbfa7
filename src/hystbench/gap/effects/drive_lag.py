"""``drive-lag``: amplifier or coil, a first-order lag before the material."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.gap.effects.base import (
    Effect,
    Law,
    Moved,
    Variant,
    logarithmic,
    places_in_drive,
)
from hystbench.gap.simulation.simulation import Scene


class DriveLag(Effect):
    """A lag before everything else."""

    name = "drive-lag"
    shows = "frequency"
    place = "drive"

    def variants(self, scene: Scene) -> Iterator[Variant]:
        """Offer the lag before the first block, and behind the drive's limits."""
        times = logarithmic(scene.step / 20, scene.span / 20, 2)
        for place in places_in_drive(scene, linear=True):
            yield self.inserted(scene, place, grids={"time_constant_s": times})

    def inside(self, moved: Moved) -> Iterator[Law]:
        """Offer it before the mechanism."""
        yield self.beside_mechanism(moved, "time_constant_s", "before")
