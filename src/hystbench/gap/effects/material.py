"""Curves of the material: it gives less the more it gives, or its halves differ."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, ClassVar

import numpy as np

from hystbench.blocks import block_class
from hystbench.blocks.base import Block
from hystbench.blocks.gain import Gain
from hystbench.blocks.saturation import Saturation as Limit
from hystbench.gap.effects.effect import Effect, goes_both_ways, never_at_rest
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


def soft_limits(effect: Effect, passed: Passed, words: str = "") -> Iterator[Law]:
    """Offer soft limits of what comes out of a host, met hard and hardly.

    Parameters
    ----------
    effect : Effect
        Whose they are.
    passed : Passed
    words : str
        Begins the name of each form.
    """
    of = partial(effect.curve, "behind", law="saturation")
    for share in (1.1, 2.0):
        level = share * passed.shown
        yield of(words, level=level)
        form = f"{words} algebraic".strip()
        soft = {"sharpness": (SOFTEST, SHARPEST)}
        yield of(form, ranges=soft, level=level, sharpness=3.0)


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
        """Offer it behind the host, by each law."""
        yield from soft_limits(self, passed)

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


ONE_WAY = 0.98
"""Largest difference of two slopes: beyond it, hardly anything goes the other way."""
EXPONENTIAL, SLOPES = "exponential-curve", "two-slopes"


class Asymmetry(Effect):
    """An even term behind the hysteresis, before it or beside it, or a field bias.

    Before a base that holds no hysteresis a square, an exponential curve or two slopes.
    """

    name = "asymmetry"
    shows = "amplitude"
    place = "material"
    offsets: ClassVar = {"bias": (("bias", "U"), ("zero", "Y"))}
    laws: ClassVar = ("butterfly", EXPONENTIAL, SLOPES)

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer the square behind the hysteresis, and three laws of the field.

        The field has a square of its own (a magnetic circuit about its working point),
        a constant bias, or the square of it that lags (a butterfly).
        """
        for place in (simulation.behind_hysteresis, *places_between_halves(simulation)):
            yield from self._squares(simulation, place, "square")
        known, loop = simulation.hysteresis, simulation.loop
        start = loop if known is None else known
        if start is not None:
            yield self._bias(simulation, start)
            yield from self._squares(simulation, start, "square of the field")
        if known is not None:
            yield self._butterfly(simulation, known)
        if loop is None:
            yield from self._exponential(simulation)
            if goes_both_ways(simulation.at(0)):
                yield self._slopes(simulation)

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer three curves before the host.

        The square, as of a force by the square of a current, an exponential curve, and
        two slopes.
        """
        for size in (0.1, -0.1, 10.0, -10.0):  # a little of a square, hardly else
            yield self.curve("before", "square", coefficient=size / passed.given)
        for size in (1.0, -1.0):
            curvature = size / passed.given
            yield self.curve(
                "before", "exponential", law=EXPONENTIAL, curvature=curvature
            )
        for size in (0.1, -0.1) if passed.both_ways else ():
            yield self.curve(
                *("before", "two slopes"),
                law=SLOPES,
                ranges={"difference": (-ONE_WAY, ONE_WAY)},
                difference=size,
            )

    def without_itself(self, blocks: Sequence[Block]) -> tuple[Block, ...] | None:
        """Leave a sensor's zero alone, without a bias of the field."""
        if len(blocks) != len(self.offsets["bias"]):
            return None
        bias, zero = blocks
        nothing: dict[str, Any] = {"offset": 0.0}
        return replace(bias, **nothing), zero

    def _slopes(self, simulation: Simulation) -> Variant:
        """Offer two slopes, which are a gain where the input goes one way alone.

        Where nothing goes one way it is a limit of the drive.
        """
        return self.inserted(
            simulation,
            0,
            law=SLOPES,
            form="two slopes",
            unit={"difference": 1e-3},
            limits={"difference": (-ONE_WAY, ONE_WAY)},
            refused={"difference": "either"},
        )

    def _squares(
        self, simulation: Simulation, place: int, form: str
    ) -> Iterator[Variant]:
        """Offer the square, and of a signal with a bias one about a point of its range.

        About zero it would change the gain and the offset at the bias.
        """
        middle, half = simulation.middle_and_half(place)
        unit = {"coefficient": 1e-3 / simulation.largest(place)}
        yield self.inserted(simulation, place, form=form, unit=unit)
        if never_at_rest(simulation.at(place)):
            yield self.inserted(
                simulation,
                place,
                form=f"{form} about a bias",
                grids={"about": np.array([middle])},
                unit=unit,
                limits={"about": (middle - half, middle + half)},
            )

    def _exponential(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer a curve that grows steeper, and one that grows flatter."""
        steeper = logarithmic(0.3, 10.0, 4) / simulation.largest(0)
        for form, axis in (
            ("exponential", steeper),
            ("exponential, flatter", -steeper[::-1]),
        ):
            grids = {"curvature": axis}
            yield self.inserted(simulation, 0, law=EXPONENTIAL, form=form, grids=grids)

    def _butterfly(self, simulation: Simulation, start: int) -> Variant:
        """The square of a play operator of the field."""
        amplitude = simulation.largest(start)
        size = simulation.largest(simulation.behind_hysteresis) / amplitude**2
        return self.inserted(
            simulation,
            start + 1,
            law="butterfly",
            form="butterfly",
            grids={"threshold": logarithmic(0.02 * amplitude, 0.7 * amplitude, 4)},
            unit={"coefficient": 1e-3 * size},
        )

    def _bias(self, simulation: Simulation, start: int) -> Variant:
        """A constant added to the field; the sensor is set to zero with it on."""
        gain = block_class("gain")
        behind = simulation.behind_hysteresis
        loop, rest = simulation.chain[start:behind], simulation.chain[behind:]

        def build(given: Values) -> tuple[Block, ...]:
            bias, zero = (
                gain.from_mapping({"value": 1.0, "offset": given[name]})
                for name in ("bias", "zero")
            )
            return (bias, *loop, zero, *rest)

        return Variant(
            self.name,
            self.place,
            "bias",
            start,
            build,
            (0, len(loop) + 1),
            unit={
                "bias": 1e-3 * simulation.largest(start),
                "zero": 1e-3 * simulation.largest(behind),
            },
            free=("offset",),
        )
