"""Low-passes of the drive and of the sensor: of first order, or of second."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, Literal

import numpy as np

from hystbench.blocks.drive_lag import DriveLag as Lag
from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.law import Law, Passed
from hystbench.gap.effects.places import places_in_drive, places_in_sensor
from hystbench.gap.effects.variant import Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation
from hystbench.record import FloatArray

TIME, DAMPING, SECOND = "time_constant_s", "damping_ratio", "second order"
FILTERS = (0.5, 1.0)
"""Damping ratios of a filter that neither rings, as a mode does, nor is two lags of
which one counts: that is a lag and, nearly, a delay."""
STARTS = (0.6, 0.9)


class LowPass(Effect):
    """A lag of first order, or a filter of second order."""

    shows = "frequency"

    def at(
        self, simulation: Simulation, places: Iterable[int], times: FloatArray
    ) -> Iterator[Variant]:
        """Offer both laws at places of a chain.

        Beside another lag that of second order is left out: it would make a third
        order, which is hardly more than a lag and a delay.

        Parameters
        ----------
        simulation : Simulation
        places : iterable of int
        times : ndarray
            Time constants to search, in seconds.
        """
        has_lag = any(isinstance(block, Lag) for block in simulation.chain)
        for place in places:
            yield self.inserted(simulation, place, grids={TIME: times})
            if not has_lag:
                yield self.inserted(
                    simulation,
                    place,
                    form=SECOND,
                    grids={TIME: times, DAMPING: np.array(STARTS)},
                    limits={DAMPING: FILTERS},
                )

    def beside_host(
        self, passed: Passed, place: Literal["before", "behind"], **also: str
    ) -> Iterator[Law]:
        """Offer both laws before or behind what has effects inside.

        They start short against the records' rates, at two sampling intervals.

        Parameters
        ----------
        passed : Passed
        place : {"before", "behind"}
        **also
            Other parameters of the block.
        """
        first: dict[str, Any] = {TIME: 2.0 * passed.step}
        ranges = {TIME: (passed.shortest, np.inf)}
        yield self.curve(place, also=also, ranges=ranges, **first)
        second = {**first, DAMPING: float(np.mean(FILTERS))}
        ranges = {**ranges, DAMPING: FILTERS}
        yield self.curve(place, SECOND, also=also, ranges=ranges, **second)


class DriveLag(LowPass):
    """A lag before everything else, of first or second order."""

    name = "drive-lag"
    place = "drive"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer the lag before the first block, and behind the drive's limits."""
        times = logarithmic(simulation.step / 20, simulation.span / 20, 2)
        yield from self.at(simulation, places_in_drive(simulation, linear=True), times)

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer it before the host."""
        yield from self.beside_host(passed, "before")


class SensorLag(LowPass):
    """A lag behind the last block, of first or second order."""

    name = "sensor-lag"
    place = "sensor"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer the lag behind the last block, and before the sensor's curves."""
        times = logarithmic(simulation.step / 20, simulation.span / 20)
        yield from self.at(simulation, places_in_sensor(simulation, linear=True), times)

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer it behind the host."""
        yield from self.beside_host(passed, "behind", start="settled")
