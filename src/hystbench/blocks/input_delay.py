"""Block ``input-delay``: the drive answers late, or its record is stamped late."""

from __future__ import annotations

from math import ceil, floor

import numpy as np

from hystbench.blocks.curve import AHEAD, POINTS, value_at, weighed
from hystbench.blocks.held import HeldBlock
from hystbench.blocks.parameter import choice, number
from hystbench.blocks.starts import path_from
from hystbench.blocks.step import Sampling, Step, smooth_curve
from hystbench.record import FloatArray


class InputDelay(HeldBlock, name="input-delay", place="drive"):
    """Pure delay: ``v(t) = z(t - delay_s + lead_s)``.

    Before a record the input had its first value (``settled``), or was zero (``rest``);
    after it, it keeps the last.

    A lead is no foresight of the device: its input was written down late. With a
    band-limited input, which is what ``hold`` is by default, the value is taken
    from the smooth curve through the samples of :mod:`hystbench.blocks.curve`. For
    straight lines (``linear``) it is taken from them; for a staircase (``zero-order``)
    it is the mean over the interval that follows, which comes to the same.

    References
    ----------
    .. [1] T. I. Laakso, V. Valimaki, M. Karjalainen, U. K. Laine, "Splitting the unit
       delay: tools for fractional delay filter design", IEEE Signal Processing
       Magazine 13 (1996) 30-60.
    """

    own_hold = "band-limited"
    smooths = False

    delay_s: float = number("s", "time between command and answer", 0.0, 1e3)
    lead_s: float = number(
        "s", "time by which the command was written down late", 0.0, 1e3, 0.0
    )
    start: str = choice("input before the first sample", ("settled", "rest"), "settled")

    @classmethod
    def by(cls, delay_s: float, hold: str = "default") -> InputDelay:
        """Give the delay, or the lead where it is below zero."""
        return cls(delay_s=max(delay_s, 0.0), lead_s=max(-delay_s, 0.0), hold=hold)

    @property
    def shift_s(self) -> float:
        """How much later the input is taken, in seconds; below zero earlier."""
        return self.delay_s - self.lead_s

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the delayed input."""
        shift = self.shift_s / dt
        if self.holding != "band-limited" or len(z) < 3:
            place = np.arange(len(z))
            v: FloatArray = np.interp(place - shift, place, z)
        else:
            v = later(z, shift)
        _, before = path_from(z, self.start)
        v[: max(ceil(shift), 0)] = before
        return v

    def step(self, sampling: Sampling) -> Step:
        """Keep samples, and take the delayed one from a curve through a few of them.

        With straight lines that is through two of them, else through as many on both
        sides as there are: what the delay has left behind is known. Of what is not
        known yet, the straight line through the newest two is the guess.
        """
        smooth = self.holding == "band-limited"
        shift = self.shift_s / sampling.dt
        needed = max((AHEAD if smooth else 0) - floor(shift), 0)
        shift += sampling.ahead
        known = min(max(floor(shift), 0), AHEAD)
        points = max(sampling.points, 2 * known + 2) if smooth and shift >= 0 else 2
        first = max(floor(shift) - points // 2 + 1, 0)
        constants = {
            "shift": shift,
            "settled": float(self.start == "settled"),
            "first": first,
            "points": points,
            "taps": value_at(points, first - shift),
        }
        states = {"count": 1, "kept": first + points}
        differs = smooth_curve(points, known) if smooth else ""
        if shift < 0:
            differs = (
                f"foretells its input {ceil(-shift)} sample{'s' * (shift < -1)} to "
                "come by the straight line through the newest two"
            )
        return Step("input_delay", constants, states, gains=needed, differs=differs)


def later(z: FloatArray, samples: float) -> FloatArray:
    """Move a signal to later samples along its curve; it rests at its ends.

    Parameters
    ----------
    z : ndarray, shape (n,)
    samples : float
        Below zero it comes earlier.
    """
    whole, count, moved = floor(samples), len(z), z
    if whole != samples:
        taps = value_at(POINTS, whole - samples - AHEAD)
        moved = weighed(z, taps[np.newaxis])[0]
    start = min(max(whole + 1, 0), count)
    end = max(min(count + whole, count), 0)
    out = np.empty(count)
    out[:start], out[end:] = z[0], z[-1]
    out[start:end] = moved[start - whole : end - whole]
    return out
