"""``eddy-diffusion``: the field diffuses into a conducting core."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

from hystbench.blocks.eddy_diffusion import GEOMETRIES
from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.places import places_in_drive
from hystbench.gap.effects.variant import Values, Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation


class EddyDiffusion(Effect):
    """Magnetic diffusion before the material, in a slab, a rod or a half-space."""

    name = "eddy-diffusion"
    shows = "frequency"
    place = "drive"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer each shape of the core, behind the drive's limits as well.

        A half-space goes by the root of its time, and shows at a far shorter one.
        """
        times = logarithmic(simulation.step / 5, simulation.span / 5, 1.5)
        quick = logarithmic(1e-4 * simulation.step, simulation.span / 100, 1)
        for place in places_in_drive(simulation, linear=True):
            for geometry in GEOMETRIES:
                yield self.inserted(
                    simulation,
                    place,
                    partial(_values, geometry),
                    form=geometry,
                    grids={
                        "time_constant_s": quick if geometry == "half-space" else times
                    },
                )


def _values(geometry: str, given: Values) -> dict[str, Any]:
    return {**given, "geometry": geometry}
