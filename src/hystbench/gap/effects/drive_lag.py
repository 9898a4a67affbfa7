"""``drive-lag``: amplifier or coil, a lag before the material."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.law import Law, Passed
from hystbench.gap.effects.low_pass import low_pass, low_pass_around
from hystbench.gap.effects.places import places_in_drive
from hystbench.gap.effects.variant import Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation


class DriveLag(Effect):
    """A lag before everything else, of first or second order."""

    name = "drive-lag"
    shows = "frequency"
    place = "drive"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer the lag before the first block, and behind the drive's limits."""
        times = logarithmic(simulation.step / 20, simulation.span / 20, 2)
        for place in places_in_drive(simulation, linear=True):
            yield from low_pass(self, simulation, place, times)

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer it before the host."""
        yield from low_pass_around(self, passed, "before")
