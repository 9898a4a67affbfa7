"""``backlash``: play in the joint at the output."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.law import Law, Passed
from hystbench.gap.effects.places import has_dynamics
from hystbench.gap.effects.variant import Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation


class Backlash(Effect):
    """A play operator behind the mechanics, or before what has no hysteresis."""

    name = "backlash"
    shows = "branch"
    place = "mechanics"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer half-widths up to a third of the largest output, or input."""
        places = {simulation.behind_mechanics: ""}
        if simulation.loop is None and has_dynamics(simulation):
            places[0] = "before"
        for place, form in places.items():
            largest = simulation.largest(place)
            grid = logarithmic(3e-4 * largest, largest / 3, 4)
            yield self.inserted(
                simulation, place, form=form, grids={"half_width": grid}
            )

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer narrow and wide play behind the host, and wide play before it."""
        for share in (0.01, 0.1):
            yield self.curve("behind", half_width=share * passed.shown)
        yield self.curve("before", half_width=0.1 * passed.given)
