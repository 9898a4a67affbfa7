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

    Where the input steps within a sample interval and rests on both sides, the fastest
    is a third of that: a limit that makes three intervals of the step moves its middle
    by one, and the moment of a step is known to a sample.
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
            rates = _fastest(simulation, place) * share
            _, half = simulation.middle_and_half(place)
            slowest = min(float(rates[0]), 2 * half / simulation.span)
            yield self.inserted(
                simulation,
                place,
                grids={"rate": rates},
                limits={"rate": (slowest, float(rates[-1]))},
            )


STEP = 0.25
"""Of a step, that the signal moves in both intervals beside it together at most."""


def _fastest(simulation: Simulation, place: int) -> float:
    """Largest rate of a signal, of a step within one interval a third."""
    rates = []
    for z, record in zip(simulation.at(place), simulation.records, strict=True):
        moves = np.abs(np.diff(z))
        beside = np.convolve(moves, [1.0, 0.0, 1.0], mode="same")
        is_step = beside < STEP * moves
        rates.append(float(np.max(moves / np.where(is_step, 3, 1))) / record.dt)
    return max(rates)
