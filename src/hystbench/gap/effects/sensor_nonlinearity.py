"""``sensor-nonlinearity``: a static polynomial of the true output."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.law import Law, Passed
from hystbench.gap.effects.places import places_in_sensor
from hystbench.gap.effects.variant import Variant
from hystbench.gap.simulation.simulation import Simulation

UNSIGNED = "unsigned-sensor"


class SensorNonlinearity(Effect):
    """A square and a cube behind the last block, or a sensor that shows no sign."""

    name = "sensor-nonlinearity"
    shows = "amplitude"
    place = "sensor"
    laws = (UNSIGNED,)

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer the square, the cube and both, before the sensor's lag as well.

        And the magnitude behind all, where no measured output is below zero and
        simulated ones are.
        """
        for place in places_in_sensor(simulation):
            largest = simulation.largest(place)
            unit = {"quadratic": 1e-3 / largest, "cubic": 1e-3 / largest**2}
            for form, used in FORMS.items():
                found = self.inserted(
                    simulation,
                    place,
                    lambda given: {"quadratic": 0.0, "cubic": 0.0, **given},
                    form=form,
                    unit={name: unit[name] for name in used},
                    free=used,
                )
                yield replace(found, charge=CHARGE)

        if hides_the_sign(simulation):
            end = len(simulation.chain)
            yield self.inserted(
                simulation,
                end,
                lambda given: {"scale": 1.0},
                law=UNSIGNED,
                form="magnitude",
            )

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer it behind the host with both terms, the cube of either sign."""
        for sign in (1.0, -1.0):
            quadratic, cubic = 0.03 / passed.shown, sign * 0.03 / passed.shown**2
            yield self.curve("behind", "both", quadratic=quadratic, cubic=cubic)


BELOW = 0.05
"""Of the largest output: what is further below zero is not noise."""


def hides_the_sign(simulation: Simulation) -> bool:
    """Tell whether outputs are simulated below zero where none is measured there."""
    size = max(float(np.max(np.abs(record.y))) for record in simulation.records)
    simulated = min(float(np.min(y)) for y in simulation.output)
    measured = min(float(np.min(record.y)) for record in simulation.records)
    return simulated < -BELOW * size <= measured


CHARGE = 2.0
"""Of each form: a sensor's curve has both terms, as a rule.

One that is a square alone is more likely the material's asymmetry, and one that is a
cube alone its saturation: the same curve to the data, and one number less.
"""
FORMS = {
    "square": ("quadratic",),
    "cube": ("cubic",),
    "both": ("quadratic", "cubic"),
}
