"""What follows slowly: creep behind a step, and heat."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, ClassVar

import numpy as np

from hystbench.blocks.relaxation_force import RelaxationForce
from hystbench.gap.effects.effect import Declined, Effect
from hystbench.gap.effects.law import Law, Moved
from hystbench.gap.effects.variant import Values, Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation

SLOW_SAMPLES = 500
"""Samples of a record that shows anything slow, at least."""
QUICKEST = 200
"""A record holds so many of the shortest time constants that are slow beside it."""


class Creep(Effect):
    """One slow element, three over a decade and a half, or all over some decades.

    Inside a mechanism whose spring is known, a force beside it that fades.
    """

    name = "creep"
    shows = "slow-time"
    place = "mechanics"
    laws: ClassVar = ("logarithmic-creep", "relaxation-force")

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer creep behind the hysteresis.

        Time constants go from a two-hundredth to the whole of the longest record; a
        slower element is a ramp that one record cannot tell from drift.
        """
        if simulation.span < SLOW_SAMPLES * simulation.step:
            raise Declined("records are too short for anything slow")
        low, high = simulation.span / QUICKEST, simulation.span
        for count in (1, 3):
            unit = {f"magnitude {k + 1}": 1e-3 for k in range(count)}
            spread = SPREAD ** np.arange(count)

            def values(given: Values, spread: Any = spread) -> dict[str, Any]:
                return {
                    "magnitudes": [
                        given[f"magnitude {k + 1}"] for k in range(len(spread))
                    ],
                    "time_constants_s": [
                        float(x) for x in given["time_constant_s"] * spread
                    ],
                }

            yield self.inserted(
                simulation,
                simulation.behind_linear,
                values,
                form="one element" if count == 1 else "three elements",
                grids={
                    "time_constant_s": logarithmic(low, high / spread[-1] * 1.001, 3)
                },
                unit=unit,
                positive=tuple(unit),
                free=("magnitudes", "time_constants_s"),
                charge=2.0 * count,
            )
        for form, power in POWERS.items():
            yield self._over_decades(simulation, form, power)

    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Offer a force that fades, beside a spring that a given base states.

        Beside one that was identified it would be a pole more of what is linear.
        """
        if moved.anywhere or not moved.known:
            return
        for times in (1.0, 10.0):
            fades = RelaxationForce(
                stiffness=0.1 * moved.force / moved.reach,
                relaxation_time_s=times * moved.reach / moved.speed,
            )
            yield Law("relaxation", fades, ("stiffness", "relaxation_time_s"))

    def _over_decades(self, simulation: Simulation, form: str, power: float) -> Variant:
        """All time constants between two, as of a material without a time of its own.

        They begin anywhere between the sampling interval and the slowest that one
        record shows, and may go on beyond it.
        """
        return self.inserted(
            simulation,
            simulation.behind_linear,
            lambda given: {"power": power, **given},
            law="logarithmic-creep",
            form=form,
            grids={
                "first_time_s": logarithmic(simulation.step, simulation.span / 20, 1),
                "last_time_s": logarithmic(
                    simulation.span / 2, 10 * simulation.span, 1
                ),
            },
            limits={
                "first_time_s": (simulation.step / 5, simulation.span / 5),
                "last_time_s": (simulation.span / 4, 100 * simulation.span),
            },
            unit={"magnitude": 1e-3},
            positive=("magnitude",),
            free=("magnitude", "first_time_s", "last_time_s", "power"),
            charge=4.0,
        )


POWERS = {"logarithmic": 0.0, "fractional": 0.3}
"""Powers of time with which creep over decades grows: where the refit starts."""
SPREAD = 5.0
"""Ratio between neighbouring time constants of three elements."""


class ThermalDrift(Effect):
    """Displacement that follows the input's square, slowly."""

    name = "thermal-drift"
    shows = "slow-time"
    place = "mechanics"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer it behind the mechanics, of one body that warms and of two.

        Two bodies in a row may change places: the second one is the quicker.
        """
        end = simulation.behind_mechanics
        small = 1e-3 * simulation.largest(end) / simulation.largest(0) ** 2
        low, high = simulation.span / QUICKEST, 3 * simulation.span
        yield self.inserted(
            simulation,
            end,
            form="one body",
            grids={"time_constant_s": logarithmic(low, high, 2.5)},
            refused={"time_constant_s": "lower"},  # no body warms as fast as that
            unit={"coefficient": small},
        )
        slower = logarithmic(simulation.span / 20, high, 2.5)
        yield self.inserted(
            simulation,
            end,
            form="two bodies",
            grids={
                "time_constant_s": slower,
                "second_time_constant_s": logarithmic(low, high / 10, 2.5),
            },
            unit={"coefficient": small},
        )
