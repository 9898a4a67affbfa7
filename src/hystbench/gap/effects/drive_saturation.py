"""``drive-saturation``: the amplifier runs out of current."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.law import Law, Passed
from hystbench.gap.effects.places import places_in_drive
from hystbench.gap.effects.variant import Variant
from hystbench.gap.simulation.simulation import Simulation


class DriveSaturation(Effect):
    """A limit below the largest input of the records."""

    name = "drive-saturation"
    shows = "amplitude"
    place = "drive"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer limits from 30 to 99.5 % of the largest signal there."""
        share = 1.0 - np.geomspace(0.7, 0.005, 12)
        for place in places_in_drive(simulation):
            limits = simulation.largest(place) * share
            yield self.inserted(simulation, place, grids={"limit": limits})

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer limits before the host, met seldom and often."""
        for share in (0.9, 0.6):
            yield self.curve("before", limit=share * passed.given)
