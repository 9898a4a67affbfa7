"""``dead-zone``: a small input does nothing."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.law import Law, Passed
from hystbench.gap.effects.places import places_between_halves, places_in_drive
from hystbench.gap.effects.variant import Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation


class DeadZone(Effect):
    """A dead zone of up to half of the largest input, with corners or rounded."""

    name = "dead-zone"
    shows = "amplitude"
    place = "drive"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer the dead zone in the drive, and inside a linear base."""
        for place in (*places_in_drive(simulation), *places_between_halves(simulation)):
            largest = simulation.largest(place)
            widths = logarithmic(1e-3 * largest, 0.5 * largest, 4)
            yield self.inserted(simulation, place, grids={"half_width": widths})
            yield self.inserted(
                simulation,
                place,
                lambda given: {
                    **given,
                    "rounding": max(given["rounding"], given["half_width"]),
                },
                form="rounded",
                grids={"rounding": widths},
                unit={"half_width": 1e-3 * widths[0]},
                positive=("half_width",),
            )

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer narrow and wide ones before the host."""
        for share in (0.02, 0.15):
            width = share * passed.given
            yield self.curve("before", half_width=width)
            yield self.curve("before", "rounded", half_width=width, rounding=2 * width)
