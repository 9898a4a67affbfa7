"""``backlash``: play in the joint at the output."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.law import Law, Passed
from hystbench.gap.effects.variant import Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation


class Backlash(Effect):
    """A play operator behind the mechanics."""

    name = "backlash"
    shows = "branch"
    place = "mechanics"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer half-widths up to a third of the largest output."""
        end = simulation.behind_mechanics
        largest = simulation.largest(end)
        yield self.inserted(
            simulation,
            end,
            grids={"half_width": logarithmic(3e-4 * largest, largest / 3, 4)},
        )

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer narrow and wide play behind the host."""
        for share in (0.01, 0.1):
            yield self.curve("behind", half_width=share * passed.shown)
