"""The samples that every view reads: all records in one, thinned alike."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import cast

import numpy as np
from numpy.typing import NDArray

from hystbench.errors import InputError
from hystbench.gap.compared import Compared
from hystbench.gap.floor import Floor
from hystbench.operators import play
from hystbench.record import FloatArray

# More samples than this tell a map over an axis nothing more.
ENOUGH = 14_000
FEWEST = 32
# Thresholds of play operators, as shares of the input's largest magnitude.
THRESHOLDS = (
    0.02,
    0.05,
    0.09,
    0.13,
    0.18,
    0.24,
    0.3,
    0.37,
    0.45,
    0.54,
    0.64,
    0.74,
    0.85,
)
PRIMES = (1, 2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61)


@dataclass(frozen=True)
class Samples:
    """Records beside their simulations, read at every ``stride``-th sample.

    The stride is a prime: a periodic record is then seen at many phases, not at the
    same few again and again. Filters run on all samples and are thinned afterwards.
    Samples that were not measured are left out then.

    Parameters
    ----------
    compared : tuple of Compared
    noise : float
        Variance of the noise floor.
    stride : int
    """

    compared: tuple[Compared, ...]
    noise: float
    stride: int

    def thin(self, of: Callable[[Compared], FloatArray]) -> FloatArray:
        """Work out a signal on all samples of each record; keep every stride-th."""
        return np.concatenate(
            [
                of(item)[places]
                for item, places in zip(self.compared, self.places, strict=True)
            ]
        )

    @cached_property
    def places(self) -> list[NDArray[np.intp]]:
        """Samples of each record that are kept."""
        return [
            at[item.record.counted[at]]
            for item in self.compared
            for at in [np.arange(0, len(item.record), self.stride)]
        ]

    @cached_property
    def residual(self) -> FloatArray:
        """Measured minus simulated."""
        return self.thin(lambda item: item.residual)

    @cached_property
    def input(self) -> FloatArray:
        """Input u."""
        return self.thin(lambda item: item.record.u)

    @cached_property
    def simulated(self) -> FloatArray:
        """Simulated output."""
        return self.thin(lambda item: item.simulated)

    @cached_property
    def speed(self) -> FloatArray:
        """Input's rate du/dt, in the input's unit a second."""
        return self.thin(lambda item: np.gradient(item.record.u, item.record.dt))

    @cached_property
    def simulated_speed(self) -> FloatArray:
        """Rate of the simulated output, by a stencil of fourth order."""
        return self.thin(lambda item: derivative(item.simulated, item.record.dt))

    @cached_property
    def direction(self) -> FloatArray:
        """Plus one where the input rises, minus one where it falls.

        A turn counts once the input has moved by a hundredth of its range, so that
        noise on a measured input is no turn.
        """
        return self.thin(lambda item: _direction(item.record.u, 0.005 * self.reach))

    @cached_property
    def time(self) -> FloatArray:
        """Time from the start of each record, in seconds."""
        return self.thin(lambda item: item.record.time)

    @cached_property
    def record(self) -> NDArray[np.int64]:
        """Which record each sample is of."""
        counts = [len(places) for places in self.places]
        return np.repeat(np.arange(len(counts)), counts)

    @cached_property
    def slices(self) -> tuple[slice, ...]:
        """Where each record's samples lie."""
        counts = np.bincount(self.record, minlength=len(self.compared))
        ends = np.cumsum(counts)
        return tuple(
            slice(int(end - count), int(end))
            for end, count in zip(ends, counts, strict=True)
        )

    @cached_property
    def reach(self) -> float:
        """Largest magnitude of the input, never quite zero."""
        largest = max(float(np.max(np.abs(item.record.u))) for item in self.compared)
        return max(largest, 1e-300)

    @cached_property
    def plays(self) -> FloatArray:
        """Play operators of the input, shape (thresholds, n), in the input's unit.

        They approximate any Preisach operator, so no loop is out of their reach.
        """
        thresholds = np.array(THRESHOLDS) * self.reach
        played = self.thin(lambda item: play(item.record.u, thresholds)[0])
        return np.ascontiguousarray(played.T)

    @cached_property
    def shapes(self) -> FloatArray:
        """What a wrong shape of the base's loop could leave, orthonormal, (m, n).

        The span of powers of the input and of its play operators.
        """
        u = self.input / self.reach
        span = np.concatenate([[u, u**2, u**3], self.plays / self.reach])
        scale = np.maximum(np.sqrt(np.sum(span**2, axis=1)), 1e-300)
        values, vectors = np.linalg.eigh(span @ span.T / np.outer(scale, scale))
        kept = values > 1e-9 * max(float(values[-1]), 1e-300)
        return cast(
            FloatArray,
            (vectors[:, kept] / np.sqrt(values[kept])).T @ (span.T / scale).T,
        )

    @cached_property
    def shaped(self) -> FloatArray:
        """How much of each direction of ``shapes`` the residual holds, shape (m,)."""
        return self.shapes @ self.residual

    @cached_property
    def power(self) -> float:
        """Mean square of the residual."""
        return float(np.mean(self.residual**2))

    @cached_property
    def gap_power(self) -> float:
        """Mean square of the residual above the noise.

        At least what chance may leave of white noise of the floor's level, so that
        a share of nothing is no large number.
        """
        chance = 3 * self.noise * np.sqrt(2 / len(self.residual))
        return float(max(self.power - self.noise, chance))

    @cached_property
    def main_frequencies(self) -> FloatArray:
        """rms(du/dt) / rms(u) / 2 pi of each record, in Hz, of u about its mean."""
        found = []
        for item in self.compared:
            u = item.record.u - np.mean(item.record.u)
            speed = np.gradient(u, item.record.dt)
            rate = np.sqrt(np.mean(speed**2) / max(float(np.mean(u**2)), 1e-300))
            # An input that hardly moves has the record for its half-period.
            least = 0.5 / (len(item.record) * item.record.dt)
            found.append(max(float(rate) / (2 * np.pi), least))
        return np.array(found)

    @cached_property
    def durations(self) -> FloatArray:
        """Length of each record in seconds."""
        return np.array([len(item.record) * item.record.dt for item in self.compared])

    def share(self, explained: float, freedom: int) -> float:
        """Give explained power, what noise buys taken off, over the gap's power."""
        bought = freedom * self.noise / len(self.residual)
        return float(np.clip((explained - bought) / self.gap_power, 0.0, 1.0))


def take_samples(compared: Sequence[Compared], floor: Floor) -> Samples:
    """Choose the stride and gather the records.

    Raises
    ------
    InputError
        If a record is too short to have a spectrum.
    """
    for item in compared:
        if len(item.record) < FEWEST:
            raise InputError(
                f"{item.record.name}: expected at least {FEWEST} samples to locate a "
                f"gap, got {len(item.record)}"
            )
    total = sum(len(item.record) for item in compared)
    least = max(1, total // ENOUGH)
    stride = next((prime for prime in PRIMES if prime >= least), least)
    # A short record keeps at least a hundred samples.
    shortest = min(len(item.record) for item in compared)
    if shortest // stride < 100:
        stride = max(1, shortest // 100)
    return Samples(tuple(compared), floor.rms**2, stride)


def derivative(values: FloatArray, dt: float) -> FloatArray:
    """Differentiate by central differences of fourth order, of second at the ends."""
    slope = cast(FloatArray, np.gradient(values, dt))
    if len(values) > 4:
        slope[2:-2] = (
            8 * (values[3:-1] - values[1:-3]) - (values[4:] - values[:-4])
        ) / (12 * dt)
    return slope


def _direction(u: FloatArray, half_width: float) -> FloatArray:
    """Follow the input's direction through a play, so that noise does not turn it."""
    followed = play(u, [half_width], [float(u[0])])[0][:, 0]
    moves = np.sign(np.diff(followed, prepend=followed[0]))
    index = np.where(moves != 0, np.arange(len(u)), 0)
    return cast(FloatArray, moves[np.maximum.accumulate(index)])
