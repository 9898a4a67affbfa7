"""``calibration-error``: the sensor's gain and zero are off."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.blocks.calibration_error import CalibrationError as Sensor
from hystbench.gap.effects.effect import Declined, Effect
from hystbench.gap.effects.law import Law, Passed
from hystbench.gap.effects.variant import Variant
from hystbench.gap.simulation.simulation import Simulation
from hystbench.gap.thresholds import SHAPE


class CalibrationError(Effect):
    """A gain and an offset behind the last block."""

    name = "calibration-error"
    shows = "amplitude"
    place = "sensor"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer the gain, the offset and both.

        Beside another shape of the hysteresis there is nothing to offer: what the shape
        misses would pass for a gain, which is the shape's own already.

        Raises
        ------
        Declined
            If the chain has such a shape.
        """
        if any(block.name == SHAPE for block in simulation.chain):
            raise Declined("the other shape of the hysteresis has a gain of its own")
        end = len(simulation.chain)
        step = {"gain": 1e-3, "offset": 1e-3 * simulation.largest(end)}
        for used in FORMS:
            yield self.inserted(
                simulation,
                end,
                # The gain is solved for as what it adds to one.
                lambda given: {
                    "gain": 1.0 + given.get("gain", 0.0),
                    "offset": given.get("offset", 0.0),
                },
                form=" and ".join(used),
                unit={name: step[name] for name in used},
            )

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer them behind a host whose numbers were given.

        One that was identified from the records has a gain and an offset of its own.
        """
        if passed.shortest < passed.step:
            for used in FORMS:
                yield Law(" and ".join(used), Sensor(gain=1.0), used, "behind")


FORMS = (("gain",), ("offset",), ("gain", "offset"))
