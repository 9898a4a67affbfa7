"""Low-passes of the drive and of the sensor: of first order, or of second."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Literal

import numpy as np

from hystbench.blocks.base import Block
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


def low_pass(
    effect: Effect, simulation: Simulation, place: int, times: FloatArray
) -> Iterator[Variant]:
    """Offer both laws at a place of a chain.

    Beside another lag that of second order is left out: it would make a third order,
    which is hardly more than a lag and a delay.

    Parameters
    ----------
    effect : Effect
        ``drive-lag`` or ``sensor-lag``.
    simulation : Simulation
    place : int
    times : ndarray
        Time constants to search, in seconds.
    """
    yield effect.inserted(simulation, place, grids={TIME: times})
    if any(isinstance(block, Lag) for block in simulation.chain):
        return
    yield effect.inserted(
        simulation,
        place,
        form=SECOND,
        grids={TIME: times, DAMPING: np.array(STARTS)},
        limits={DAMPING: FILTERS},
    )


def low_pass_around(
    effect: Effect, passed: Passed, place: Literal["before", "behind"], **given: str
) -> Iterator[Law]:
    """Offer both laws before or behind what has effects inside.

    Parameters
    ----------
    effect : Effect
    passed : Passed
    place : {"before", "behind"}
    **given
        Other parameters of the block.
    """
    first = effect.filter_around(passed, TIME, place, **given)
    yield first
    block: Block = type(first.block).from_mapping(
        {**first.block.to_mapping(), DAMPING: float(np.mean(FILTERS))}
    )
    yield replace(
        first,
        form=SECOND,
        block=block,
        free=(*first.free, DAMPING),
        ranges={**first.ranges, DAMPING: FILTERS},
    )


class DriveLag(Effect):
    """A lag before everything else, of first or second order."""

    name = "drive-lag"
    shows = "frequency"
    place = "drive"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer the lag before the first block, and behind the drive's limits."""
        times = logarithmic(simulation.step / 20, simulation.span / 20, 2)
        for place in places_in_drive(simulation, linear=True):
            yield from low_pass(self, simulation, place, times)

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer it before the host."""
        yield from low_pass_around(self, passed, "before")


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
