"""The actuator: command, drive, material, mechanics and sensor, in continuous time."""

import zlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from hystbench.challenge.plant import mechanics
from hystbench.challenge.plant.hysteresis import GeneralizedPlays, PlantLoop, middle
from hystbench.challenge.plant.kind import HiddenEffect, PlantRun, Stage
from hystbench.record import FloatArray

#: Least steps of the fine grid a sample, and least steps a second.
OVERSAMPLING, LEAST_HZ = 8, 8000.0

Command = Callable[[FloatArray], FloatArray]
Act = Callable[[Stage, FloatArray], FloatArray]


@lru_cache(maxsize=16)
def _grid(excitation: Command, count: int, dt: float) -> tuple[FloatArray, FloatArray]:
    """Compute time and command, which a case asks for once a plant that it tries."""
    time: FloatArray = np.arange(count, dtype=np.float64) * dt
    u = excitation(time)
    for array in (time, u):
        array.setflags(write=False)
    return time, u


@dataclass(frozen=True)
class KnownMode:
    """A linear mode that the base model knows."""

    frequency_hz: float
    damping_ratio: float
    participation: float


@dataclass(frozen=True)
class Actuator:
    """A plant with the effects that it hides."""

    loop: PlantLoop | float
    """The hysteresis, or the gain of a material without any in um/A."""
    mode: KnownMode | None
    """The known mode."""
    effects: tuple[HiddenEffect, ...]
    seed: int
    """Seed of what is new in every record."""

    def read(
        self, excitation: Command, dt: float, samples: int, record: int
    ) -> FloatArray:
        """Compute what the sensor gives to its converter, without noise.

        Parameters
        ----------
        excitation : callable
            Command in A at any times in s; zero before the start.
        dt : float
            Sampling interval of the record in seconds.
        samples : int
        record : int
            Number of the record, for what is new in each.

        Returns
        -------
        ndarray, shape (samples,)
            In um. The reading is sampled as it is: inputs are smooth, and what lies
            above half the sampling rate is orders below the noise.
        """
        step = max(OVERSAMPLING, int(np.ceil(LEAST_HZ * dt)))
        # some samples more, so that a clock that is off still finds a reading
        count = (samples + 8) * step
        fine = dt / step
        time, u = _grid(excitation, count, fine)

        def act(stage: Stage, signal: FloatArray) -> FloatArray:
            return self._act(stage, signal, time, u, fine, record)

        commanded = act("command", time)
        v = u if commanded is time else excitation(commanded)
        field = act("field", act("drive", v))
        strain, zero = self._material(field, act)
        moved = act("mechanics", self._mode(act("material", strain), fine, act))
        reading = act("sensor", moved - zero)
        taken: FloatArray = np.arange(samples, dtype=np.float64) * dt
        asked = act("sampling", taken)
        if asked is not taken:
            place = asked / fine
            k = np.clip(place.astype(np.int64), 1, count - 3)
            return cubic(reading, k, place - k)
        return np.ascontiguousarray(reading[: samples * step : step])

    def convert(self, reading: FloatArray, dt: float, record: int) -> FloatArray:
        """Compute what is written down of a reading, with whatever noise it has."""
        time: FloatArray = np.arange(len(reading), dtype=np.float64) * dt
        return self._act("samples", reading, time, reading, dt, record)

    def _act(
        self,
        stage: Stage,
        signal: FloatArray,
        time: FloatArray,
        u: FloatArray,
        dt: float,
        record: int,
    ) -> FloatArray:
        for effect in self.effects:
            if effect.stage == stage:
                key = zlib.crc32(effect.kind.name.encode())
                random = np.random.default_rng([self.seed, record, key])
                run = PlantRun(time, u, dt, random)
                signal = effect.act(signal, run)
        return signal

    def _material(self, field: FloatArray, act: Act) -> tuple[FloatArray, float]:
        """Strain from zero on, and where the sensor was set to zero.

        A bias moves the loop. The sensor is set to zero in the middle of the major
        loop, as it is without a bias; the strain itself has no jump at the start.
        """
        if isinstance(self.loop, float):
            return self.loop * (field - field[0]), 0.0
        grows = any(effect.stage == "threshold" for effect in self.effects)
        if grows and isinstance(self.loop, GeneralizedPlays):
            z = self.loop.respond(field, act("threshold", field))
        else:
            z = self.loop.respond(field)
        if field[0] == 0.0:
            return z, 0.0
        shift = middle(self.loop, float(field[0])) - middle(self.loop, 0.0)
        return z - z[0], shift - float(z[0])

    def _mode(self, z: FloatArray, dt: float, act: Act) -> FloatArray:
        if any(effect.stage == "mode" for effect in self.effects):
            return act("mode", z)
        if self.mode is None:
            return z
        p = self.mode
        x = mechanics.oscillate(z, dt, p.frequency_hz, p.damping_ratio, 0.0)
        return (1.0 - p.participation) * z + p.participation * x


def cubic(values: FloatArray, k: NDArray[np.int64], p: FloatArray) -> FloatArray:
    """Read at ``k + p`` by the cubic of Catmull and Rom through the four around.

    Parameters
    ----------
    values : ndarray, shape (m,)
    k : ndarray of int, shape (n,)
        From 1 to m - 3.
    p : ndarray, shape (n,)
        From 0 to 1.
    """
    before, here, after, second = (values[k + i] for i in (-1, 0, 1, 2))
    return np.asarray(
        here
        + 0.5 * p * (after - before)
        + p**2 * (before - 2.5 * here + 2.0 * after - 0.5 * second)
        + 0.5 * p**3 * (second - before + 3.0 * (here - after))
    )
