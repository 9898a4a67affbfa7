"""The samples that every view reads: all records in one, thinned alike."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import cast

import numpy as np

from hystbench.gap.records.floor import Floor
from hystbench.gap.records.scored_samples import Compared, ScoredSamples
from hystbench.gap.view_kinds import ViewKind
from hystbench.operators import play
from hystbench.record import FloatArray

MOST_SAMPLES = 14_000
"""Most samples of a map over an axis: more tell nothing more."""
PRIMES = (1, 2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61)
TURN_SHARE = 0.01
"""Share of the input's range that it moves before a turn counts: noise is no turn."""


@dataclass(frozen=True)
class Contribution:
    """What a named effect adds to the output of the base on each record."""

    effect: str
    view: ViewKind | None
    """View in which it shows, what an engineer looks at first; None where that is not
    known."""
    added: tuple[FloatArray, ...]
    """Shape (n,). In the unit of the output, a record each."""
    freedom: float = 1.0
    """Numbers that were fitted for it."""
    to_a_retuned_base: bool = False
    """Whether numbers of the base were fitted first: they may have taken its part."""

    @property
    def words(self) -> str:
        """What it is called in a sentence."""
        base = " to the re-tuned base" if self.to_a_retuned_base else ""
        return f"what {self.effect} adds{base}"


@dataclass(frozen=True)
class ViewSamples:
    """Records beside their simulations, read at every ``stride``-th sample.

    The stride is a prime: a periodic record is then seen at many phases, not at the
    same few again and again. Filters run on all samples and are thinned afterwards.
    Samples that were not measured are left out then.
    """

    compared: tuple[Compared, ...]
    floor: Floor
    stride: int
    contributions: tuple[Contribution, ...] = ()
    """What named effects add."""

    def thinned(self, signals: Sequence[FloatArray]) -> FloatArray:
        """Keep every stride-th sample of a signal of each record."""
        return self.kept.take(signals)

    @cached_property
    def kept(self) -> ScoredSamples:
        """Samples of each record that are kept."""
        places = (np.arange(0, len(x.record), self.stride) for x in self.compared)
        pairs = zip(places, self.compared, strict=True)
        return ScoredSamples(tuple(at[x.record.counted[at]] for at, x in pairs))

    @cached_property
    def residual(self) -> FloatArray:
        """Measured minus simulated."""
        return self.thinned([item.residual for item in self.compared])

    @cached_property
    def input(self) -> FloatArray:
        """Input u."""
        return self.thinned([item.record.u for item in self.compared])

    @cached_property
    def simulated(self) -> FloatArray:
        """Simulated output."""
        return self.thinned([item.simulated for item in self.compared])

    @cached_property
    def speed(self) -> FloatArray:
        """Input's rate du/dt, in the input's unit a second."""
        return self.thinned(
            [np.gradient(item.record.u, item.record.dt) for item in self.compared]
        )

    @cached_property
    def direction(self) -> FloatArray:
        """Plus one where the input rises, minus one where it falls."""
        half = 0.5 * TURN_SHARE * self.reach
        return self.thinned([_direction(x.record.u, half) for x in self.compared])

    @cached_property
    def time(self) -> FloatArray:
        """Time from the start of each record, in seconds."""
        return self.thinned([item.record.time for item in self.compared])

    @cached_property
    def reach(self) -> float:
        """Largest magnitude of the input, never quite zero."""
        largest = max(float(np.max(np.abs(item.record.u))) for item in self.compared)
        return max(largest, 1e-300)

    @property
    def units(self) -> tuple[str, str]:
        """Units of input and output."""
        record = self.compared[0].record
        return record.input.unit, record.output.unit

    @property
    def noise(self) -> float:
        """Variance of the noise floor."""
        return self.floor.square

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
        least = 3 * self.noise * np.sqrt(2 / len(self.residual))
        return float(max(self.power - self.noise, least, 1e-300))

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

    def share(self, explained: float, freedom: float) -> float:
        """Give explained power, what noise buys taken off, over the gap's power."""
        bought = freedom * self.noise / len(self.residual)
        return float(np.clip((explained - bought) / self.gap_power, 0.0, 1.0))


def take_samples(
    compared: Sequence[Compared],
    floor: Floor,
    contributions: Sequence[Contribution] = (),
) -> ViewSamples:
    """Choose the stride and gather the records."""
    total = sum(len(item.record) for item in compared)
    least = max(1, total // MOST_SAMPLES)
    stride = next((prime for prime in PRIMES if prime >= least), least)
    # A short record keeps at least a hundred samples.
    shortest = min(len(item.record) for item in compared)
    if shortest // stride < 100:
        stride = max(1, shortest // 100)
    return ViewSamples(tuple(compared), floor, stride, tuple(contributions))


def _direction(u: FloatArray, half_width: float) -> FloatArray:
    """Follow the input's direction through a play, so that noise does not turn it."""
    followed = play(u, [half_width], [float(u[0])])[:, 0]
    moves = np.sign(np.diff(followed, prepend=followed[0]))
    index = np.where(moves != 0, np.arange(len(u)), 0)
    return cast(FloatArray, moves[np.maximum.accumulate(index)])
