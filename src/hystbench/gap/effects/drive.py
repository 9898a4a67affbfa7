"""Effects of the drive: the input acts late, slowly, or not in full."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np
from scipy.special import expit, logit

from hystbench.blocks.eddy_diffusion import GEOMETRIES
from hystbench.blocks.velocity_limit import VelocityLimit
from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.law import Law, Moved, Passed
from hystbench.gap.effects.material import SHARPEST, SOFTEST, STRAIGHT
from hystbench.gap.effects.places import (
    drives_a_machine,
    places_between_halves,
    places_in_drive,
)
from hystbench.gap.effects.variant import Refused, Values, Variant, logarithmic
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
        ranges = {"delay_s": (passed.shortest, np.inf)}
        yield self.curve("before", ranges=ranges, delay_s=2.0 * passed.step)


class EddyDiffusion(Effect):
    """Magnetic diffusion before the material, in a slab, a rod or a half-space."""

    name = "eddy-diffusion"
    shows = "frequency"
    place = "drive"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer each shape of the core, behind the drive's limits as well.

        A half-space goes by the root of its time, and shows at a far shorter one.
        """
        times = logarithmic(simulation.step / 5, simulation.span / 5, 1.5)
        quick = logarithmic(1e-4 * simulation.step, simulation.span / 100, 1)
        for place in places_in_drive(simulation, linear=True):
            for geometry in GEOMETRIES:
                yield self.inserted(
                    simulation,
                    place,
                    partial(_values, geometry),
                    form=geometry,
                    grids={
                        "time_constant_s": quick if geometry == "half-space" else times
                    },
                )


def _values(geometry: str, given: Values) -> dict[str, Any]:
    return {**given, "geometry": geometry}


def _of_form(law: str, given: Values) -> dict[str, Any]:
    return {**given, "form": law}


HARD = 100.0
"""Dampings that make the force at the largest velocity, beyond a limit of it."""


class SlewLimit(Effect):
    """A rate below the fastest of the records' inputs, hard or soft, or of a servo.

    A hard one and a servo's may go down at another rate than up.

    Where the input steps within a sample interval and rests on both sides, the fastest
    is a third of that: a limit that makes three intervals of the step moves its middle
    by one, and the moment of a step is known to a sample.
    """

    name = "slew-limit"
    shows = "rate"
    place = "drive"
    laws = ("velocity-limit",)

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer rates from 2 to 98 % of the fastest there.

        They are close together at both ends: just below the fastest rate the effect
        sets in, and far below it the output grows with the limit. A refit may go down
        to the rate at which the input's range takes a whole record: the fastest of a
        record of steps says little about the drive. The soft limit is of an amplifier
        that lags below it as well, by up to a twentieth of the longest record.
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
            two = rates[-1] * TWO_RATES
            yield self.inserted(
                simulation,
                place,
                form="of two rates",
                grids={"rate": two, "falling": two},
                limits=dict.fromkeys(("rate", "falling"), (slowest, float(rates[-1]))),
            )
            # An amplifier or a servo lags below its limit as well.
            # Of a lag of less than a sample, or as long as a record, nothing is seen.
            longest = simulation.span / 20
            if longest <= simulation.step:
                continue
            lags = logarithmic(simulation.step, longest, 1.5)
            for form, law in (("soft", "rounded"), ("of a servo", "sharp")):
                yield self.inserted(
                    simulation,
                    place,
                    partial(_of_form, law),
                    form=form,
                    grids={"rate": rates[-1] * LAGGING_SHARES, "time_constant_s": lags},
                    limits={"rate": (slowest, float(rates[-1]))},
                    refused={"rate": "upper", "time_constant_s": "either"},
                )

    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Offer a servo that goes no faster, a little and far below its fastest."""
        damping = HARD * moved.force / moved.speed
        for share in (0.3, 0.7):
            block = VelocityLimit(rate=share * moved.speed, damping=damping)
            yield Law("of a servo", block, ("rate",))


TWO_RATES = np.array([0.03, 0.06, 0.12, 0.25, 0.5, 0.9])
"""Rates up and down of a drive for which they differ, over the fastest of its input."""
LAGGING_SHARES = np.array([0.1, 0.3, 0.6, 0.95])
"""Rates of an amplifier or a servo that also lags, over the fastest of its input."""
STEP = 0.25
"""Largest move in the two intervals beside a step together, as a share of the step."""


def _fastest(simulation: Simulation, place: int) -> float:
    """Largest rate of a signal, of a step within one interval a third."""
    rates = []
    for z, record in zip(simulation.at(place), simulation.records, strict=True):
        moves = np.abs(np.diff(z))
        beside = np.convolve(moves, [1.0, 0.0, 1.0], mode="same")
        is_step = beside < STEP * moves
        rates.append(float(np.max(moves / np.where(is_step, 3, 1))) / record.dt)
    return max(rates)


class DeadZone(Effect):
    """A dead zone of up to half of the input: with corners, rounded, of two edges."""

    name = "dead-zone"
    shows = "amplitude"
    place = "drive"
    laws = ("dead-band",)

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer the dead zone in the drive, and inside a linear base."""
        for place in (*places_in_drive(simulation), *places_between_halves(simulation)):
            largest = simulation.largest(place)
            widths = logarithmic(1e-3 * largest, 0.5 * largest, 4)
            yield self.inserted(simulation, place, grids={"half_width": widths})
            yield self.inserted(
                simulation,
                place,
                lambda given: {
                    **given,
                    "rounding": max(given["rounding"], given["half_width"]),
                },
                form="rounded",
                grids={"rounding": widths},
                unit={"half_width": 1e-3 * widths[0]},
                positive=("half_width",),
            )
            lowest, highest = _ends(simulation, place)
            if lowest < 0.0 < highest:
                yield self.inserted(
                    simulation,
                    place,
                    law="dead-band",
                    form="of two edges",
                    grids={"upper": EDGES * highest, "lower": EDGES[::-1] * lowest},
                )

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer narrow and wide ones before the host."""
        for share in (0.02, 0.15):
            width = share * passed.given
            yield self.curve("before", half_width=width)
            yield self.curve("before", "rounded", half_width=width, rounding=2 * width)


EDGES = np.array([0.01, 0.03, 0.08, 0.2, 0.5])
"""Edges of a dead zone over the largest input on their side."""
LIMITS = np.array([0.02, 0.1, 0.3, 0.55, 0.75, 0.9, 0.98])
"""Limits of a drive over the largest input on their side."""
MIDDLE = 0.5
"""Share of it from which a fit of one limit goes either way."""
NOTHING = 1e-6
"""Share of it that is none."""


def _ends(simulation: Simulation, place: int) -> tuple[float, float]:
    """Give the lowest and the highest value of a signal."""
    signals = simulation.at(place)
    return min(float(z.min()) for z in signals), max(float(z.max()) for z in signals)


SOFT = {"sharpness": (SOFTEST, SHARPEST)}
"""Sharpness of a soft limit: a sharper one is the hard one."""
ROUND = np.array([5.0, 8.0, 14.0])
"""Sharpness of limits with rounded corners that are tried."""


class DriveSaturation(Effect):
    """A limit of the input, or one each way: hard; alike, it may be rounded or soft."""

    name = "drive-saturation"
    shows = "amplitude"
    place = "drive"
    laws = ("drive-limits", "saturation")

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
            yield from self._apart(simulation, place)
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

    def _apart(self, simulation: Simulation, place: int) -> Iterator[Variant]:
        """Offer a limit on one side, and one on each."""
        lowest, highest = _ends(simulation, place)
        sides = {}
        if highest > 0.0:
            sides["upper"] = LIMITS * highest
        if lowest < 0.0:
            sides["lower"] = LIMITS[::-1] * lowest
        # A drive of one sign ends at zero.
        limits = {
            side: (min(x[0], NOTHING * x[0]), max(x[-1], NOTHING * x[-1]))
            for side, x in sides.items()
        }
        of_law = partial(
            self.inserted, simulation, place, law="drive-limits", limits=limits
        )
        for side, levels in sides.items():
            yield of_law(form=f"{side} alone", grids={side: levels})
        if len(sides) == 2:
            # At the outer end of its range a limit is none.
            outer: dict[str, Refused] = {"upper": "upper", "lower": "lower"}
            yield of_law(form="of two levels", grids=sides, refused=outer)

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer limits before the host, met seldom and often, hard and soft.

        One on one side alone too, where the input goes to both.
        """
        if passed.both_ways:
            level = MIDDLE * passed.given
            one = partial(self.curve, "before", law="drive-limits")
            yield one("upper alone", ranges={"upper": (0.0, np.inf)}, upper=level)
            yield one("lower alone", ranges={"lower": (-np.inf, 0.0)}, lower=-level)
        for share in (0.9, 0.6):
            level = share * passed.given
            yield self.curve("before", limit=level)
            soft = partial(self.curve, "before", law="saturation", level=level)
            yield soft(form="soft")
            yield soft(form="algebraic", sharpness=3.0, ranges=SOFT)
