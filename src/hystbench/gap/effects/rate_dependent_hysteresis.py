"""``rate-dependent-hysteresis``: the loop widens with rate."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from hystbench.errors import InputError
from hystbench.gap.effects.effect import Declined, Effect
from hystbench.gap.effects.variant import Values, Variant
from hystbench.gap.simulation.simulation import Simulation


class RateDependentHysteresis(Effect):
    """Thresholds that grow with rate, or a field that the rate takes away."""

    name = "rate-dependent-hysteresis"
    shows = "rate"
    place = "material"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer three laws around the hysteresis.

        The coefficient is searched by what it does at the fastest rate of the records,
        from one exponent or another, which the refit moves.
        """
        if simulation.hysteresis is None:
            raise Declined("the chain has no hysteresis that could widen")
        amplitude = simulation.largest(simulation.hysteresis)
        field = np.geomspace(2e-3, 0.5, 5) * amplitude
        sizes = {
            "growing-thresholds": np.geomspace(0.03, 20, 5),
            "excess-field": field,
            "acting-field": field,
        }
        if not can_grow(simulation):
            del sizes["growing-thresholds"]
        for form, at_fastest in sizes.items():
            for exponent in EXPONENTS[form]:
                found = self.inserted(
                    simulation,
                    simulation.hysteresis + 1,
                    partial(_values, form, exponent),
                    form=f"{form}, {exponent:g}",
                    grids={
                        "coefficient": at_fastest / simulation.fastest() ** exponent
                    },
                    free=("coefficient", "exponent"),
                    zero={"coefficient": 0.0},
                )
                yield replace(found, charge=2.0)


EXPONENTS = {
    "growing-thresholds": (0.5, 1.0),
    "excess-field": (0.5, 1.0),
    # With an exponent of one the field that acts is a plain lag of the drive.
    "acting-field": (0.5,),
}
"""Where the search for each law starts; the refit moves the exponent."""


def _values(form: str, exponent: float, given: Values) -> dict[str, Any]:
    return {"exponent": exponent, **given, "form": form}


def can_grow(simulation: Simulation) -> bool:
    """Tell whether the hysteresis has thresholds that can grow."""
    assert simulation.hysteresis is not None  # noqa: S101  (the caller has looked)
    try:
        simulation.chain[simulation.hysteresis].check_growth()  # type: ignore[attr-defined]
    except InputError:
        return False
    return True
