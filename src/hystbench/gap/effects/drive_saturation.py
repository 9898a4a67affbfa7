"""``drive-saturation``: the amplifier runs out of current."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hystbench.blocks.saturation import Saturation
from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.law import Law, Passed
from hystbench.gap.effects.places import drives_a_machine, places_in_drive
from hystbench.gap.effects.saturation import SHARPEST, SOFTEST, STRAIGHT
from hystbench.gap.effects.variant import Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation

SOFT = {"sharpness": (SOFTEST, SHARPEST)}
"""Of a soft limit: a sharper one is the hard one."""
ROUND = np.array([5.0, 8.0, 14.0])
"""Sharpness of limits with rounded corners that are tried."""


class DriveSaturation(Effect):
    """A limit of the input: hard, rounded, or soft before a mass or a store."""

    name = "drive-saturation"
    shows = "amplitude"
    place = "drive"
    laws = ("saturation",)

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer limits from 30 to 99.5 % of the largest signal there.

        Before what moves a mass or fills a store, where no material stands, soft ones
        as well; before a material those that leave half of the range straight.
        """
        share = 1.0 - np.geomspace(0.7, 0.005, 12)
        soft = drives_a_machine(simulation)
        for place in places_in_drive(simulation):
            largest = simulation.largest(place)
            yield self.inserted(simulation, place, grids={"limit": largest * share})
            if soft:
                levels = logarithmic(0.3 * largest, 30 * largest, 5)
                yield self.inserted(
                    simulation,
                    place,
                    law="saturation",
                    form="soft",
                    grids={"level": levels},
                )
                continue
            yield self.inserted(
                simulation,
                place,
                law="saturation",
                form="rounded",
                grids={
                    "level": logarithmic(0.3 * largest, 2 * largest, 5),
                    "sharpness": ROUND,
                },
                limits={"sharpness": (STRAIGHT, SHARPEST)},
                refused={"sharpness": "either"},
            )

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer limits before the host, met seldom and often, hard and soft."""
        for share in (0.9, 0.6):
            level = share * passed.given
            yield self.curve("before", limit=level)
            yield Law("soft", Saturation(level=level), ("level",), "before")
            corner = Saturation(level=level, sharpness=3.0)
            yield Law(
                "algebraic", corner, ("level", "sharpness"), "before", ranges=SOFT
            )
