"""Block ``input-delay``: the drive answers late."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hystbench.blocks.band_limited import sine_series
from hystbench.blocks.held import HeldBlock, Hold
from hystbench.blocks.parameter import number
from hystbench.blocks.step import Sampling, Step, smooth_curve, value_at
from hystbench.record import FloatArray


@dataclass(frozen=True)
class InputDelay(HeldBlock):
    """Pure delay: ``v(t) = z(t - delay_s)``; before the record z rests at its start.

    Exact for a band-limited input, which is what ``hold`` is by default: the delay is
    a phase. The curve through the samples then knows samples to come. For straight
    lines (``linear``) the value is taken from them; for a staircase (``zero-order``)
    it is its mean over the interval that follows, which comes to the same.

    References
    ----------
    .. [1] T. I. Laakso, V. Valimaki, M. Karjalainen, U. K. Laine, "Splitting the unit
       delay: tools for fractional delay filter design", IEEE Signal Processing
       Magazine 13 (1996) 30-60.
    """

    name: ClassVar = "input-delay"
    place: ClassVar = "drive"
    reference: ClassVar = (
        "Laakso et al., IEEE Signal Processing Magazine 13 (1996) 30-60"
    )

    own_hold: ClassVar[Hold] = "band-limited"
    smooths: ClassVar[bool] = False

    delay_s: float = number("s", "time between command and answer", 0.0, 1e3)

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the delayed input."""
        shift, place = self.delay_s / dt, np.arange(len(z))
        if self.holding != "band-limited" or len(z) < 3:
            between: FloatArray = np.interp(place - shift, place, z)
            return between
        series = sine_series(z)
        turn = np.exp(-2j * np.pi * series.frequency_hz(dt) * self.delay_s)
        v = series.line(len(z), shift) + series.sines(len(z), turn)
        v[place < shift] = z[0]
        return v

    def step(self, sampling: Sampling) -> Step:
        """Keep samples, and take the delayed one from a curve through a few of them.

        With straight lines that is through two of them, else through as many on both
        sides as there are.
        """
        shift = self.delay_s / sampling.dt
        points = sampling.points if self.holding == "band-limited" else 2
        first = max(int(shift) - points // 2 + 1, 0)
        constants = {
            "shift": shift,
            "first": first,
            "points": points,
            "taps": value_at(points, first - shift),
        }
        states = {"count": 1, "kept": first + points}
        differs = smooth_curve(points) if points > 2 else ""
        return Step("input_delay", constants, states, differs=differs)
