"""``input-delay``: the input acts late."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.law import Law, Passed
from hystbench.gap.effects.variant import Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation


class InputDelay(Effect):
    """A delay before everything else, up to a twentieth of the longest record."""

    name = "input-delay"
    shows = "delay"
    place = "drive"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer the delay before the first block.

        Where an input does not begin at zero, also one of a device that was idle before
        the record, as dynamics of the chain that begin at rest say.
        """
        grids = {"delay_s": logarithmic(simulation.step / 20, simulation.span / 20, 2)}
        yield self.inserted(simulation, 0, grids=grids)
        if any(z[0] != 0.0 for z in simulation.at(0) if len(z)):
            yield self.inserted(
                simulation,
                0,
                lambda given: {**given, "start": "rest"},
                form="idle before",
                grids=grids,
            )

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer it before the host."""
        yield self.filter_around(passed, "delay_s", "before")
