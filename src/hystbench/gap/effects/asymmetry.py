"""``asymmetry``: positive and negative halves differ."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar

import numpy as np

from hystbench.blocks import block_class
from hystbench.blocks.base import Block
from hystbench.blocks.exponential_curve import ExponentialCurve
from hystbench.gap.effects.effect import Effect, never_at_rest
from hystbench.gap.effects.law import Law, Passed
from hystbench.gap.effects.places import places_between_halves
from hystbench.gap.effects.variant import Values, Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation

EXPONENTIAL = "exponential-curve"


class Asymmetry(Effect):
    """An even term behind the hysteresis, before it or beside it, or a field bias.

    Before a base that holds no hysteresis a square or an exponential curve.
    """

    name = "asymmetry"
    shows = "amplitude"
    place = "material"
    offsets: ClassVar = {"bias": (("bias", "U"), ("zero", "Y"))}
    laws: ClassVar = ("butterfly", EXPONENTIAL)

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

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer two curves before the host.

        The square, as of a force by the square of a current, and an exponential curve.
        """
        for size in (0.1, -0.1, 10.0, -10.0):  # a little of a square, hardly else
            yield self.curve("before", "square", coefficient=size / passed.given)
        for size in (1.0, -1.0):
            block = ExponentialCurve(curvature=size / passed.given)
            yield Law("exponential", block, ("curvature",), "before")

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
