"""Block ``store``: a tank whose outflow follows a power of its level."""

import numpy as np

from hystbench import kernels
from hystbench.blocks.attached import Others
from hystbench.blocks.curve import held_lines
from hystbench.blocks.held import HeldBlock
from hystbench.blocks.parameter import HUGE, TINY, choice, number
from hystbench.blocks.step import Sampling, Step, lines_of
from hystbench.record import FloatArray

PART = 0.1
"""Largest share of its level, at most, that a store loses in one step."""
MOST = 64
"""Steps of one interval, at most."""
HALVINGS = 60
"""Of the range of a level, until it is known to a rounding."""
STARTS = ("given", "settled")
"""Level at the start: the one that is given, or where it rests under the first
inflow."""


class Store(HeldBlock, name="store", place="base"):
    """Level h of a store, 0 to its height: ``h' = gain z + bias - rate h^exponent``.

    With an exponent of a half it is a tank with a free outlet (Torricelli), with one it
    is linear. What would rise above the height is spilt, at once, or over a weir by
    ``weir (h - height)^1.5`` [2]_. The output is the level, or what leaves: the outflow
    and the share of what is spilt that the next store catches.
    With ``start: settled`` it begins at the level where as much leaves as comes in at
    first. Second-order Runge-Kutta method.

    References
    ----------
    .. [1] M. Schoukens, P. Mattsson, T. Wigren, J.-P. Noel, "Cascaded tanks benchmark
       combining soft and hard nonlinearities", Workshop on Nonlinear System
       Identification Benchmarks, 2016.
    .. [2] ISO 1438:2017, Hydrometry: open channel flow measurement using thin-plate
       weirs.
    """

    gain: float = number("Q/(U s)", "of the inflow")
    rate: float = number("Q^(1-e)/s", "of the outflow", 0.0)
    exponent: float = number("-", "e, of the level in the outflow", 0.1, 3.0, 0.5)
    height: float = number("Q", "level at which it overflows", TINY, default=HUGE)
    caught: float = number("-", "share of what is spilt that goes on", 0.0, 1.0, 0.0)
    weir: float = number(
        "Q^-0.5/s", "spill by the level above the height", TINY, default=HUGE
    )
    bias: float = number("Q/s", "constant inflow", default=0.0)
    start_level: float = number("Q", "level at the first sample", 0.0, default=0.0)
    output: str = choice("what the output is", ("level", "outflow"), "level")
    start: str = choice("level at the first sample", STARTS, "given")

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Fill and empty the store."""
        inflow, fine = self._inflow(z)
        n = len(inflow)
        level, outflow, spilt = np.zeros(n), np.zeros(n), np.zeros(n)
        if n == 0:
            return level
        level[0] = self._first(inflow[0])
        numbers = self._numbers(dt / fine)
        kernels.call("hb_store", n, *numbers, inflow, level, outflow, spilt)
        return self._given(level, outflow, spilt, fine)

    def near(
        self, z: FloatArray, u: FloatArray, dt: float, others: Others
    ) -> list[FloatArray]:
        """Compute the output, and those of others with numbers near, to first order."""
        inflow, fine = self._inflow(z)
        n, count = len(inflow), len(others)
        if self._is_exact or n == 0:
            return [x.simulate(own, u, dt) for x, own in ((self, z), *others)]
        level, outflow, spilt = np.zeros(n), np.zeros(n), np.zeros(n)
        level[0] = self._first(inflow[0])
        levels, outflows, spills = (np.zeros((n, count)) for _ in range(3))
        inflows = np.empty((n, count))
        for k, (other, own) in enumerate(others):
            its, _ = other._inflow(own)
            inflows[:, k] = its - inflow
            levels[0, k] = other._first(its[0]) - level[0]
        differ = (
            np.array([getattr(x, name) - getattr(self, name) for x, _ in others])
            for name in ("rate", "exponent", "height", "weir")
        )
        numbers, made = self._numbers(dt / fine), (inflow, level, outflow, spilt)
        beside = (*differ, inflows, levels, outflows, spills)
        kernels.call("hb_store_near", n, *numbers, *made, count, *beside)
        found = [self._given(level, outflow, spilt, fine)]
        for k, (other, _) in enumerate(others):
            moved = level + levels[:, k], outflow + outflows[:, k], spilt + spills[:, k]
            found.append(other._given(*moved, fine))
        return found

    def _inflow(self, z: FloatArray) -> tuple[FloatArray, int]:
        """Give corners of the inflow's lines, and how many lie in an interval."""
        lines, fine = held_lines(z, self.holding)
        return self.gain * lines + self.bias, fine

    def _numbers(self, dt: float) -> tuple[float, ...]:
        """Give what a kernel is told of the store and of an interval."""
        ramp = float(self.holding != "zero-order")
        law = self.rate, self.exponent, self.height, self.weir
        return (self._parts(dt), dt, ramp, *law)

    def _given(
        self, level: FloatArray, outflow: FloatArray, spilt: FloatArray, fine: int
    ) -> FloatArray:
        """Give the output at the samples."""
        if self.output == "level":
            return level[::fine]
        # What was spilt is a mean over the interval before, in parts or whole.
        of_intervals = spilt[1:].reshape(-1, fine).mean(axis=1)
        return outflow[::fine] + self.caught * np.append(0.0, of_intervals)

    def step(self, sampling: Sampling) -> Step:
        """Fill and empty it over the interval that has passed."""
        lines = lines_of(self.holding, sampling)
        parts = self._parts(sampling.dt / lines.segments)
        constants = {
            "gain": self.gain,
            "bias": self.bias,
            **lines.constants,
            "parts": parts,
            "t": sampling.dt / lines.segments / parts,
            **self.constants("rate", "exponent", "height", "weir"),
            "start": self.start_level,
            "settled": int(self.start == "settled"),
            "outflow": int(self.output == "outflow"),
            "caught": self.caught,
        }
        return Step("store", constants, {"level": 1, **lines.states}, **lines.told)

    def _first(self, inflow: float) -> float:
        """Give the level at the first sample; a store that loses nothing is full."""
        sharp = self.weir >= HUGE
        if self.start == "given":
            return min(self.start_level, self.height) if sharp else self.start_level
        if inflow <= 0.0:
            return 0.0
        with np.errstate(divide="ignore", over="ignore"):
            rests = float(np.power(np.divide(inflow, self.rate), 1.0 / self.exponent))
        if rests <= self.height or sharp:
            return min(rests, self.height)
        low, high = self.height, self.height + (inflow / self.weir) ** (2 / 3)
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            over = self.weir * (middle - self.height) ** 1.5
            if self.rate * middle**self.exponent + over < inflow:
                low = middle
            else:
                high = middle
        return float(high)

    def _parts(self, dt: float) -> int:
        """Steps of an interval: none empties more than a part of the store.

        One is exact of a store that is linear and does not overflow.
        """
        if self._is_exact:
            return 1
        return int(np.clip(np.ceil(self.rate * dt / PART), 1, MOST))

    @property
    def _is_exact(self) -> bool:
        return self.exponent == 1.0 and self.height >= HUGE
