"""Block ``calibration-error``: a sensor read with the wrong gain and zero."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import HUGE, number
from hystbench.blocks.step import Sampling, Step, polynomial
from hystbench.record import FloatArray


@dataclass(frozen=True)
class CalibrationError(Block):
    """Sensor with gain and zero error: ``y = gain z + offset``.

    References
    ----------
    .. [1] JCGM 200:2012, International vocabulary of metrology (VIM), 4.28.
    """

    name: ClassVar = "calibration-error"
    place: ClassVar = "sensor"
    reference: ClassVar = "JCGM 200:2012, International vocabulary of metrology"

    gain: float = number("-", "ratio of read to true output", 0.1, 10.0)
    offset: float = number("Y", "reading at zero", -HUGE, HUGE, default=0.0)

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the reading."""
        return self.gain * z + self.offset

    def step(self, sampling: Sampling) -> Step:
        """Give the straight line."""
        return polynomial(self.offset, self.gain)
