"""``input-delay``: the input acts late."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.law import Law, Moved
from hystbench.gap.effects.variant import Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation


class InputDelay(Effect):
    """A delay before everything else, up to a twentieth of the longest record."""

    name = "input-delay"
    shows = "delay"
    place = "drive"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer the delay before the first block."""
        yield self.inserted(
            simulation,
            0,
            grids={
                "delay_s": logarithmic(simulation.step / 20, simulation.span / 20, 2)
            },
        )

    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Offer it before the mechanism."""
        yield self.around_mechanism(moved, "delay_s", "before")
