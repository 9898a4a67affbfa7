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
    """A rate below the fastest of the records' inputs.

    The fastest is taken over three sample intervals. Where the input steps within one,
    a limit that makes three of it moves the middle of the step by one, and the moment
    of a step is known to a sample.
    """

    name = "slew-limit"
    shows = "rate"
    place = "drive"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer rates from 2 to 98 % of the fastest there.

        They are close together at both ends: just below the fastest rate the effect
        sets in, and far below it the output grows with the limit. A refit may go down
        to the rate at which the input's range takes a whole record: the fastest of a
        record of steps says little about the drive.
        """
        share = expit(np.linspace(logit(0.02), logit(0.98), 16))
        for place in places_in_drive(simulation):
            rates = simulation.fastest(place, over=3) * share
            _, half = simulation.middle_and_half(place)
            slowest = min(float(rates[0]), 2 * half / simulation.span)
            yield self.inserted(
                simulation,
                place,
                grids={"rate": rates},
                limits={"rate": (slowest, float(rates[-1]))},
            )
