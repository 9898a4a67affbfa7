"""Loops of the material: a new one, another shape, or one that widens with rate."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import fields, replace
from functools import partial
from typing import Any, ClassVar

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.wrapping import PlayBlock
from hystbench.envelope import Envelope
from hystbench.errors import InputError
from hystbench.gap.effects.effect import Declined, Effect
from hystbench.gap.effects.places import has_dynamics, only_lags
from hystbench.gap.effects.variant import Values, Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation

OPERATORS = 8
BEND = 0.5
"""Argument of the hyperbolic tangent at the largest input, where the search starts."""
PLAYS = "prandtl-ishlinskii"
FORM = "plays"
"""Form of plain plays beside a linear path; another is of generalized ones."""
BOUC_WEN = "bouc-wen"
NEAREST, FARTHEST = 0.03, 10.0
"""Yield distance, in halves of the input's range: nearer it switches as a relay does,
farther a loop grows by the square of the way and only the weight over it shows."""
SHARINGS = np.array([0.1, 0.4, 0.8])
DAHL, ELASTIC = 0.01, 1.0
"""Ends of the sharing: Dahl's loop, and a curve without one."""


class Hysteresis(Effect):
    """Play operators or a loop of Bouc and Wen before everything else, or behind it.

    What is heated through a lag has its loop behind that.

    Plain plays lie beside a linear path: the chain has its gain already. Their weights
    may have any sign, as may that of the loop. Generalized plays have envelopes, from
    nearly straight and alike ones on; the refit bends them.
    """

    name = "hysteresis"
    shows = "branch"
    place = "material"
    laws: ClassVar = (PLAYS, BOUC_WEN)

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer operators over the range of the input, and a loop that yields in it."""
        if simulation.hysteresis is not None:
            raise Declined("the chain has a hysteresis already")
        if simulation.loop is not None and simulation.chain[simulation.loop].reruns:
            raise Declined("the simulator has a hysteresis already")
        if simulation.middle_and_half(0)[1] == 0.0:
            raise Declined("the input does not move")
        places = [0]
        if has_dynamics(simulation) and only_lags(simulation):
            places.append(len(simulation.chain))
        for place in places:
            yield self._generalized(simulation, place)
            yield self._plays(simulation, place)
            yield self._bouc_wen(simulation, place)

    def without_itself(self, blocks: Sequence[Block]) -> tuple[Block, ...] | None:
        """Let all plays be that of the least threshold: a curve, without a loop."""
        if not all(isinstance(block, PlayBlock) for block in blocks):
            return None
        every: Sequence[Any] = blocks
        return tuple(
            replace(x, weights=(sum(x.weights), *(0.0 for _ in x.weights[1:])))
            for x in every
        )

    def _plays(self, simulation: Simulation, place: int) -> Variant:
        """Plays beside a linear path.

        The law's cubes stay zero: with them a search takes five times as long.
        """
        _, half = simulation.middle_and_half(place)
        thresholds = [float(x) for x in half * np.arange(OPERATORS) / OPERATORS]
        names = [f"weight {k}" for k in range(OPERATORS)]

        def values(given: Values) -> dict[str, Any]:
            weights = [given[name] for name in names]
            return {"thresholds": thresholds, "weights": weights}

        return self.inserted(
            simulation,
            place,
            values,
            law=PLAYS,
            form=_standing(FORM, place),
            unit=dict.fromkeys(names, 1e-3),
            free=("weights",),
        )

    def _bouc_wen(self, simulation: Simulation, place: int) -> Variant:
        """Bouc and Wen's loop beside a linear path: no few plays are one."""
        _, half = simulation.middle_and_half(place)
        return self.inserted(
            simulation,
            place,
            law=BOUC_WEN,
            form=_standing("Bouc-Wen", place),
            grids={
                "yield_distance": half * logarithmic(0.1, 3.0),
                "sharing": SHARINGS,
            },
            unit={"weight": 1e-3},
            limits={
                "yield_distance": (NEAREST * half, FARTHEST * half),
                "sharing": (DAHL, ELASTIC),
            },
            refused={"sharing": "upper"},
        )

    def _generalized(self, simulation: Simulation, place: int) -> Variant:
        middle, half = simulation.middle_and_half(place)
        thresholds = [float(x) for x in half * np.arange(OPERATORS) / OPERATORS]
        slope = BEND / half
        curve = 1 / slope, slope, -slope * middle, middle  # of slope one in the middle
        envelope = dict(zip((x.name for x in fields(Envelope)), 2 * curve, strict=True))
        names = [f"weight {k}" for k in range(1, OPERATORS)]

        def values(given: Values) -> dict[str, Any]:
            weights = [given[name] for name in names]
            # The first operator gives what the others leave of a gain of one.
            return {
                "envelope": envelope,
                "thresholds": thresholds,
                "weights": [max(1.0 - sum(weights), 0.0), *weights],
            }

        found = self.inserted(
            simulation,
            place,
            values,
            form=_standing("generalized plays", place),
            unit=dict.fromkeys(names, 1e-3),
            positive=tuple(names),
            free=("weights", "envelope"),
            neutral=False,
            charge=float(OPERATORS + len(envelope)),
        )
        return replace(found, begun=True)


def _standing(form: str, place: int) -> str:
    """Name a form with where it stands, if not before everything else."""
    return f"{form} behind" if place else form


class HysteresisShape(Effect):
    """Play operators, their squares, and powers of the input beside the hysteresis.

    Its parameters are many: it is charged for all the directions that reshaping has.
    """

    name = "hysteresis-shape"
    shows = "branch"
    place = "material"
    free_forms = ("",)

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer the correction of the chain's hysteresis."""
        if simulation.hysteresis is None:
            raise Declined("the chain has no hysteresis whose shape could be wrong")
        amplitude = simulation.largest(simulation.hysteresis)
        thresholds = [amplitude * k / PLAYS_OF_SHAPE for k in range(1, PLAYS_OF_SHAPE)]
        weights = [f"weight {k}" for k in range(1, PLAYS_OF_SHAPE)]
        squares = [f"square {k}" for k in range(1, PLAYS_OF_SHAPE)]
        powers = [f"power {k}" for k in range(1, POWERS_OF_SHAPE + 1)]
        size = 1e-3 * simulation.largest(simulation.behind_hysteresis)
        unit = (
            dict.fromkeys(weights, size / amplitude)
            | dict.fromkeys(squares, size / amplitude**2)
            | {name: size / amplitude**k for k, name in enumerate(powers, start=1)}
        )
        yield self.inserted(
            simulation,
            simulation.hysteresis + 1,
            lambda given: {
                "thresholds": thresholds,
                "weights": [given[name] for name in weights],
                "square_weights": [given[name] for name in squares],
                "powers": [given[name] for name in powers],
            },
            unit=unit,
            free=("weights", "square_weights", "powers"),
        )


PLAYS_OF_SHAPE = 10
POWERS_OF_SHAPE = 5


class RateDependentHysteresis(Effect):
    """Thresholds that grow with rate, or a field that the rate takes away."""

    name = "rate-dependent-hysteresis"
    shows = "rate"
    place = "material"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer three laws around the hysteresis, and thresholds with a logarithm.

        The coefficient is searched by what it does at the fastest rate of the records,
        from one exponent or another, which the refit moves. A logarithm begins far
        below that rate, or near it, and the refit moves where.
        """
        if simulation.hysteresis is None:
            raise Declined("the chain has no hysteresis that could widen")
        offer = partial(
            self.inserted,
            simulation,
            simulation.hysteresis + 1,
            zero={"coefficient": 0.0},
            charge=2.0,
        )
        fastest = simulation.fastest()
        grown = np.geomspace(0.03, 20, 5)
        field = np.geomspace(2e-3, 0.5, 5) * simulation.largest(simulation.hysteresis)
        grows = can_grow(simulation)
        for form, exponents in EXPONENTS.items():
            threshold = form == "growing-thresholds"
            coefficients = grown if threshold else field
            for exponent in exponents if grows or not threshold else ():
                yield offer(
                    partial(_widened, form, exponent),
                    form=f"{form}, {exponent:g}",
                    grids={"coefficient": coefficients / fastest**exponent},
                    free=("coefficient", "exponent"),
                )
        for share in KNEES if grows else ():
            knee = share * fastest
            yield offer(
                partial(_bent, knee),
                form=f"growing-thresholds, logarithm from {share:g}",
                grids={"coefficient": grown / (knee * np.arcsinh(1 / share))},
                free=("coefficient", "knee"),
            )


KNEES = (0.01, 0.3)
"""Share of the fastest rate beyond which thresholds grow with the logarithm."""
EXPONENTS = {
    "growing-thresholds": (0.5, 1.0),
    "excess-field": (0.5, 1.0),
    # With an exponent of one the field that acts is a plain lag of the drive.
    "acting-field": (0.5,),
}
"""Exponents at which the search for each law starts; the refit moves them."""


def _widened(form: str, exponent: float, given: Values) -> dict[str, Any]:
    return {"exponent": exponent, **given, "form": form}


def _bent(knee: float, given: Values) -> dict[str, Any]:
    return {"exponent": 1.0, "knee": knee, **given}


def can_grow(simulation: Simulation) -> bool:
    """Tell whether the hysteresis has thresholds that can grow."""
    assert simulation.hysteresis is not None  # noqa: S101  (the caller has looked)
    try:
        simulation.chain[simulation.hysteresis].check_growth()  # type: ignore[attr-defined]
    except InputError:
        return False
    return True
