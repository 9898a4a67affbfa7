"""``sensor-lag``: the sensor is late."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from hystbench.blocks.drive_lag import DriveLag
from hystbench.blocks.sensor_lag import SensorLag as Block
from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.law import Law, Passed
from hystbench.gap.effects.places import places_in_sensor
from hystbench.gap.effects.variant import Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation

FILTERS = (0.5, 1.0)
"""Damping ratios of a filter that neither rings, as a mode does, nor is two lags of
which one counts: that is a lag and, nearly, a delay."""


class SensorLag(Effect):
    """A lag behind the last block, of first or second order."""

    name = "sensor-lag"
    shows = "frequency"
    place = "sensor"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer the lag behind the last block, and before the sensor's curves."""
        times = logarithmic(simulation.step / 20, simulation.span / 20)
        # With a lag it would be of third order: hardly more than a lag and a delay.
        lags = any(isinstance(block, DriveLag) for block in simulation.chain)
        for place in places_in_sensor(simulation, linear=True):
            yield self.inserted(simulation, place, grids={"time_constant_s": times})
            if lags:
                continue
            yield self.inserted(
                simulation,
                place,
                form="second order",
                grids={"time_constant_s": times, "damping_ratio": np.array([0.6, 0.9])},
                limits={"damping_ratio": FILTERS},
            )

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer it behind the host."""
        first = self.filter_around(passed, "time_constant_s", "behind", start="settled")
        yield first
        yield replace(
            first,
            form="second order",
            block=Block.from_mapping(
                {**first.block.to_mapping(), "damping_ratio": 0.8}
            ),
            free=(*first.free, "damping_ratio"),
            ranges={**first.ranges, "damping_ratio": FILTERS},
        )
