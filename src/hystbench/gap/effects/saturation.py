"""``saturation``: the material gives less the more it gives."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.gain import Gain
from hystbench.blocks.saturation import Saturation as Limit
from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.law import Law, Passed
from hystbench.gap.effects.places import (
    drives_a_machine,
    places_between_halves,
    places_in_drive,
)
from hystbench.gap.effects.variant import Values, Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation

SOFTEST, SHARPEST = 1.0, 20.0
"""Froelich's law of magnetisation; a curve within 3.4 % of a corner."""
STRAIGHT, BENT = 4.0, 5.0
"""Sharpness of the softest limit of a drive and of the sharpest law of a field. An
amplifier is straight within 1 or 2 % up to half of its limit; a material bends from its
smallest signals on. In between it may be either."""
STRONG, STRONGEST = 0.5, 0.1
"""Share of the largest signal that the level may be; behind a linear base, which may
follow the curve nearly everywhere, where it is met nearly always."""
WEAKEST = 1000.0
"""Largest signals that the level may be of the softest law, whose curve is nearest."""


class Saturation(Effect):
    """An odd, soft limit behind the hysteresis or of the field, of any sharpness."""

    name = "saturation"
    shows = "amplitude"
    place = "material"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer levels from half, or a tenth, to thirty times the largest signal there.

        Of the output, or of the field that drives the hysteresis. A linear base does
        not say where in it the material is: before it, inside or behind it.
        """
        places = {simulation.behind_hysteresis, *places_between_halves(simulation)}
        if simulation.loop is None and not _is_static(simulation):
            places |= {simulation.behind_mechanics, _before_the_offset(simulation)}
            yield self._about_a_point(simulation, _before_the_offset(simulation))
        if drives_a_machine(simulation):
            places.discard(0)  # what limits a force that is given is the drive
        for place in sorted(places):
            yield from self._at(simulation, place)
        if simulation.hysteresis is not None:
            yield from self._at(simulation, simulation.hysteresis, "field")

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer it behind the host, by each law, met hard and hardly."""
        for share in (1.1, 2.0):
            level = share * passed.shown
            yield self.curve("behind", level=level)
            corner = self.curve("behind", "algebraic", level=level, sharpness=3.0)
            yield replace(corner, ranges={"sharpness": (SOFTEST, SHARPEST)})

    def _at(
        self, simulation: Simulation, place: int, of: str = ""
    ) -> Iterator[Variant]:
        largest = simulation.largest(place)
        of_drive = bool(of) or place in places_in_drive(simulation)
        sharpest = BENT if of_drive else SHARPEST
        sharpness = np.array([SOFTEST, 2.0, 3.0, 4.5, 8.0])
        least = (STRONGEST if simulation.loop is None else STRONG) * largest
        levels = logarithmic(least, 30 * largest, 5)
        yield self.inserted(simulation, place, form=of, grids={"level": levels})
        yield self.inserted(
            simulation,
            place,
            form=f"{of}, algebraic" if of else "algebraic",
            grids={
                "level": levels,
                "sharpness": sharpness[sharpness < sharpest],
            },
            limits={
                "level": (least, WEAKEST * largest),
                "sharpness": (SOFTEST, sharpest),
            },
            # A corner of what drives the material is the drive's limit.
            refused={"sharpness": "upper"} if of_drive else {},
        )

    def _about_a_point(self, simulation: Simulation, place: int) -> Variant:
        """Offer a limit that is nearer on one side: an offset before it."""
        rest, largest = simulation.chain[place:], simulation.largest(place)

        def build(given: Values) -> tuple[Block, ...]:
            moved = Gain(value=1.0, offset=given.get("offset", 0.0))
            return (moved, Limit(level=given["level"]), *rest)

        return Variant(
            self.name,
            self.place,
            "about a point",
            place,
            build,
            (0, 1),
            grids={"level": logarithmic(STRONGEST * largest, 30 * largest, 5)},
            unit={"offset": 1e-3 * largest},
            free=("level", "offset"),
            neutral=False,
        )


def _before_the_offset(simulation: Simulation) -> int:
    """Give the place behind the last block that is no gain: there zero is the input's.

    Behind it an offset may follow, as of a sensor.
    """
    place = simulation.behind_mechanics
    while place and isinstance(simulation.chain[place - 1], Gain):
        place -= 1
    return place


def _is_static(simulation: Simulation) -> bool:
    """Tell whether a chain is gains alone: before and behind it is the same place."""
    return all(isinstance(block, Gain) for block in simulation.chain)
