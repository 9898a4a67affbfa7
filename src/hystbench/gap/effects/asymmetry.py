"""``asymmetry``: positive and negative halves differ."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar

from hystbench.blocks import block_class
from hystbench.blocks.base import Block
from hystbench.blocks.exponential_curve import ExponentialCurve
from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.law import Law, Passed
from hystbench.gap.effects.places import places_between_halves
from hystbench.gap.effects.variant import Values, Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation

EXPONENTIAL = "exponential-curve"


class Asymmetry(Effect):
    """An even term behind the hysteresis, before it or beside it, or a field bias.

    Or an exponential curve before a base that holds no hysteresis.
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
            yield self._square(simulation, place, "square")
        known, loop = simulation.hysteresis, simulation.loop
        start = loop if known is None else known
        if start is not None:
            yield self._bias(simulation, start)
            yield self._square(simulation, start, "square of the field")
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

    def _square(self, simulation: Simulation, place: int, form: str) -> Variant:
        unit = {"coefficient": 1e-3 / simulation.largest(place)}
        return self.inserted(simulation, place, form=form, unit=unit)

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
