"""Block ``drift``: the zero wanders slowly."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import HUGE, number, numbers
from hystbench.record import FloatArray


@dataclass(frozen=True)
class Drift(Block):
    """Slow motion of the zero: ``y = z + slope t + path(t)``.

    Time t starts at 0 in each record. The path starts at zero and goes in straight
    lines through values at evenly spaced times, the last at the record's last sample.
    A zero error at the start is no drift: ``calibration-error`` has it as its offset.

    References
    ----------
    .. [1] A. J. Fleming, "A review of nanometer resolution position sensors",
       Sensors and Actuators A 190 (2013) 106-126: drift of sensors.
    """

    name: ClassVar = "drift"
    place: ClassVar = "sensor"
    reference: ClassVar = "Fleming, Sensors and Actuators A 190 (2013) 106-126"

    slope: float = number("Y/s", "steady rate", -HUGE, HUGE)
    path: tuple[float, ...] = numbers(
        "Y",
        "values at evenly spaced times, the last at the end",
        -HUGE,
        HUGE,
        optional=True,
    )

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Add the drift."""
        place = np.arange(len(z))
        y = z + self.slope * dt * place
        if self.path:
            knots = np.linspace(0.0, max(len(z) - 1, 1), len(self.path) + 1)
            y += np.interp(place, knots, (0.0, *self.path))
        return y
