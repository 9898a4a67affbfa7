"""``sensor-lag``: the sensor is late."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.law import Law, Passed
from hystbench.gap.effects.low_pass import low_pass, low_pass_around
from hystbench.gap.effects.places import places_in_sensor
from hystbench.gap.effects.variant import Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation


class SensorLag(Effect):
    """A lag behind the last block, of first or second order."""

    name = "sensor-lag"
    shows = "frequency"
    place = "sensor"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer the lag behind the last block, and before the sensor's curves."""
        times = logarithmic(simulation.step / 20, simulation.span / 20)
        for place in places_in_sensor(simulation, linear=True):
            yield from low_pass(self, simulation, place, times)

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer it behind the host."""
        yield from low_pass_around(self, passed, "behind", start="settled")
