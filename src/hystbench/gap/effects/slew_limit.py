"""``slew-limit``: the amplifier follows no faster than a rate."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.special import expit, logit

from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.places import places_in_drive
from hystbench.gap.effects.variant import Variant
from hystbench.gap.simulation.simulation import Simulation


class SlewLimit(Effect):
    """A rate below the fastest of the records' inputs."""

    name = "slew-limit"
    shows = "rate"
    place = "drive"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer rates from 2 to 98 % of the fastest there.

        They are close together at both ends: just below the fastest rate the effect
        sets in, and far below it the output grows with the limit.
        """
        share = expit(np.linspace(logit(0.02), logit(0.98), 16))
        for place in places_in_drive(simulation):
            rates = simulation.fastest(place) * share
            yield self.inserted(simulation, place, grids={"rate": rates})
