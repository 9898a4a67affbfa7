"""Block ``input-delay``: the drive answers late."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hystbench.blocks.curve import AHEAD, POINTS, value_at, weighed
from hystbench.blocks.held import HeldBlock, Hold
from hystbench.blocks.parameter import number
from hystbench.blocks.step import Sampling, Step, smooth_curve
from hystbench.record import FloatArray


@dataclass(frozen=True)
class InputDelay(HeldBlock):
    """Pure delay: ``v(t) = z(t - delay_s)``; before the record z rests at its start.

    With a band-limited input, which is what ``hold`` is by default, the value is taken
    from the smooth curve through the samples of :mod:`hystbench.blocks.curve`. For
    straight lines (``linear``) it is taken from them; for a staircase (``zero-order``)
    it is the mean over the interval that follows, which comes to the same.

    References
    ----------
    .. [1] T. I. Laakso, V. Valimaki, M. Karjalainen, U. K. Laine, "Splitting the unit
       delay: tools for fractional delay filter design", IEEE Signal Processing
       Magazine 13 (1996) 30-60.
    """

    name: ClassVar = "input-delay"
    place: ClassVar = "drive"

    own_hold: ClassVar[Hold] = "band-limited"
    smooths: ClassVar[bool] = False

    delay_s: float = number("s", "time between command and answer", 0.0, 1e3)

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the delayed input."""
        shift, place = self.delay_s / dt, np.arange(len(z))
        if self.holding != "band-limited" or len(z) < 3:
            between: FloatArray = np.interp(place - shift, place, z)
            return between
        whole = min(int(shift), len(z))
        taps = value_at(POINTS, whole - shift - AHEAD)
        v = np.full(len(z), z[0])
        v[whole:] = weighed(z, taps[np.newaxis])[0, : len(z) - whole]
        v[place < shift] = z[0]
        return v

    def step(self, sampling: Sampling) -> Step:
        """Keep samples, and take the delayed one from a curve through a few of them.

        With straight lines that is through two of them, else through as many on both
        sides as there are: what the delay has left behind is known.
        """
        smooth, shift = self.holding == "band-limited", self.delay_s / sampling.dt
        known = min(int(shift) + sampling.ahead, AHEAD)
        shift += sampling.ahead
        points = max(sampling.points, 2 * known + 2) if smooth else 2
        first = max(int(shift) - points // 2 + 1, 0)
        constants = {
            "shift": shift,
            "first": first,
            "points": points,
            "taps": value_at(points, first - shift),
        }
        states = {"count": 1, "kept": first + points}
        differs = smooth_curve(points, known) if smooth else ""
        gains = max(AHEAD - int(self.delay_s / sampling.dt), 0) if smooth else 0
        return Step("input_delay", constants, states, gains=gains, differs=differs)
