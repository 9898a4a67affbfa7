"""Excitations that an experiment could use, within what the actuator bears."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.errors import InputError
from hystbench.files import write_columns
from hystbench.record import Channel, FloatArray, Record, column_name
from hystbench.signals import Signal
from hystbench.spectra import fastest_hz
from hystbench.waveforms.chirp import Chirp

#: Part of the input's power below its bandwidth.
POWER_SHARE = 0.999
#: Samples of a candidate: enough to tell two models apart.
MOST_SAMPLES = 20_000
#: Periods without which a sine has not settled.
SETTLED_PERIODS = 3
#: Frequencies of sines, their amplitudes as shares of half the range, and the levels
#: about which minor loops are tried.
FREQUENCIES, AMPLITUDES, BIASES = 12, (0.25, 0.5, 1.0), 5
#: Units by the end of a parameter's name; without one it has the input's.
UNITS = {"hz": "Hz", "s": "s"}

Numbers = Mapping[str, float | list[float]]
#: Kind, signal about the middle of the range, and what makes it.
Offer = tuple[str, FloatArray, Numbers]


@dataclass(frozen=True)
class Limits:
    """What an experiment may ask of the actuator."""

    low: float
    high: float
    """Range of the input, in its unit."""
    rate: float
    """Largest rate of the input, in its unit per second."""
    bandwidth_hz: float
    """Highest frequency."""
    dt: float
    """Sampling interval in seconds."""
    duration_s: float
    """Longest record."""

    def __post_init__(self) -> None:
        """Refuse limits that no excitation fits."""
        if not self.low < self.high:
            raise InputError(
                f"limits: low {self.low:g} and high {self.high:g}; expected low < high"
            )
        for name in ("rate", "bandwidth_hz", "dt", "duration_s"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0):
                raise InputError(f"limits: {name}: {value:g}; expected above 0")
        if self.duration_s < 100 * self.dt:
            raise InputError(
                f"limits: duration_s: {self.duration_s:g}; expected at least 100 "
                f"sampling intervals, {100 * self.dt:g} s"
            )

    @classmethod
    def of(
        cls, records: Sequence[Record], asked: Mapping[str, float] | None = None
    ) -> Limits:
        """Take what is asked, by name, and the rest from records.

        What was done once can be done again.
        """
        own = {
            "low": min(float(record.u.min()) for record in records),
            "high": max(float(record.u.max()) for record in records),
            "rate": max(record.fastest for record in records),
            "bandwidth_hz": max(fastest_hz(x.u, x.dt, POWER_SHARE) for x in records),
            "dt": min(record.dt for record in records),
            "duration_s": max(len(record) * record.dt for record in records),
        }
        return cls(**(own | dict(asked or {})))

    @property
    def middle(self) -> float:
        """Middle of the input's range."""
        middle = (self.high + self.low) / 2
        return 0.0 if abs(middle) < 1e-9 * self.half else middle

    @property
    def half(self) -> float:
        """Half of the input's range."""
        return (self.high - self.low) / 2

    @property
    def time(self) -> FloatArray:
        """Times of the samples of a candidate, in seconds."""
        count = round(min(self.duration_s / self.dt, MOST_SAMPLES))
        return np.asarray(np.arange(count) * self.dt, dtype=np.float64)

    @property
    def frequencies(self) -> FloatArray:
        """From a few periods in a record to the bandwidth, equal ratios apart."""
        lowest = SETTLED_PERIODS / min(self.duration_s, MOST_SAMPLES * self.dt)
        highest = min(self.bandwidth_hz, 0.2 / self.dt)
        count = FREQUENCIES if highest > lowest else 1
        return np.geomspace(lowest, max(highest, lowest), count)


@dataclass(frozen=True, repr=False)
class Excitation:
    """An input that could be tried."""

    kind: str
    parameters: dict[str, dict[str, Any]]
    """All that makes it: ``value`` and ``unit`` by name, as gap.json has them."""
    dt: float
    """Sampling interval in seconds."""
    u: FloatArray
    """Shape (n,)."""

    @property
    def words(self) -> str:
        """Kind and parameters, as in ``sine (frequency 40 Hz, amplitude 2 A)``."""
        told = []
        for name, about in self.parameters.items():
            plain = name.removesuffix("_hz").removesuffix("_s").replace("_", " ")
            value = about["value"]
            values = value if isinstance(value, list) else [value]
            shown = ", ".join(f"{item:.3g}" for item in values)
            told.append(f"{plain} {shown} {about['unit']}".rstrip())
        return f"{self.kind.replace('-', ' ')} ({', '.join(told)})"

    def write(self, channel: Channel, path: str | Path) -> None:
        """Write it as a signal file, whole or not at all.

        A table of time in seconds and the input, its column named as those of datasets
        are; or, by a path that ends in ``.npz``, an archive as the workflow's signals
        are, which ``hystbench simulate`` runs a model on.

        Parameters
        ----------
        channel : Channel
            The input's.
        path : str or Path
        """
        if Path(path).suffix == ".npz":
            Signal("next-experiment", self.dt, self.u, channel.unit).save(path)
            return
        name = column_name(channel.name, channel.unit)
        columns = {"time_s": np.arange(len(self.u)) * self.dt, name: self.u}
        write_columns(path, columns, 9)


def candidates(limits: Limits, unit: str) -> tuple[Excitation, ...]:
    """Make the excitations that keep within the limits.

    Sines at several frequencies and amplitudes; minor loops at several bias levels;
    multisine and chirp over the band; steps with long holds; slow ramps.

    Parameters
    ----------
    limits : Limits
    unit : str
        Of the input.

    Returns
    -------
    tuple of Excitation
        Each within range and rate; one that is too fast at full amplitude is made
        smaller.
    """
    makers = [(make, limits) for make in (_sines, _wide_bands, _slow)]
    if limits.duration_s > MOST_SAMPLES * limits.dt:
        # What is slow is sampled more coarsely, so that it lasts as long as it may.
        makers.append((_slow, replace(limits, dt=limits.duration_s / MOST_SAMPLES)))
    return tuple(
        Excitation(kind, _with_units(numbers, unit, len(u) * own.dt), own.dt, u)
        for make, own in makers
        for kind, about_middle, numbers in make(own)
        for u in [own.middle + about_middle]
        if _feasible(u, own)
    )


def _with_units(numbers: Numbers, unit: str, seconds: float) -> dict[str, Any]:
    """Give each number its unit: the end of its name tells, else it is the input's."""
    return {
        name: {"value": value, "unit": UNITS.get(name.rpartition("_")[2], unit)}
        for name, value in {**numbers, "duration_s": seconds}.items()
    }


def _feasible(u: FloatArray, limits: Limits) -> bool:
    slack = 1e-6 * (limits.high - limits.low)
    within = limits.low - slack <= u.min() and u.max() <= limits.high + slack
    fastest = float(np.abs(np.diff(u)).max())
    return bool(within and 0 < fastest <= limits.rate * limits.dt * (1 + 1e-6))


def _sines(limits: Limits) -> Iterator[Offer]:
    for frequency in limits.frequencies.tolist():
        most = min(limits.half, limits.rate / (2 * np.pi * frequency))
        wave = np.sin(2 * np.pi * frequency * limits.time)
        for size in (part * most for part in AMPLITUDES):
            own = {"frequency_hz": frequency, "amplitude": size, "bias": limits.middle}
            yield "sine", size * wave, own
        # Half of the rate moves between levels, half is left for the loops.
        size = min(limits.half / BIASES, most / 2)
        levels = np.linspace(-1, 1, BIASES) * (limits.half - size)
        loops = {
            "frequency_hz": frequency,
            "amplitude": size,
            "bias_levels": (limits.middle + levels).tolist(),
        }
        yield (
            "biased-minor-loops",
            _through(levels, limits, part=0.5) + size * wave,
            loops,
        )


def _wide_bands(limits: Limits) -> Iterator[Offer]:
    frequencies = limits.frequencies
    low, high = float(frequencies[0]), float(frequencies[-1])
    size = min(limits.half, limits.rate / (2 * np.pi * high))
    ends = {"from_hz": low, "to_hz": high, "amplitude": size}
    u = Chirp.samples(
        **ends,
        duration_s=len(limits.time) * limits.dt,
        sampling_frequency_hz=1 / limits.dt,
    )
    yield "chirp", u, {**ends, "bias": limits.middle}
    raw = np.sin(2 * np.pi * np.outer(limits.time, frequencies)).sum(axis=1)
    fastest = float(np.abs(np.diff(raw)).max()) / limits.dt
    size = min(limits.half / float(np.abs(raw).max()), limits.rate / fastest)
    lines = {"frequencies_hz": frequencies.tolist(), "amplitude_each": size}
    yield "multisine", size * raw, {**lines, "bias": limits.middle}


def _slow(limits: Limits) -> Iterator[Offer]:
    count = len(limits.time)
    seconds = count * limits.dt
    for size in (part * limits.half for part in AMPLITUDES):
        levels = size * np.array([0.0, 1.0, 0.0, -1.0, 0.0])
        at = (limits.middle + levels).tolist()
        hold = seconds / len(levels)
        yield (
            "steps-with-holds",
            _through(levels, limits),
            {"levels": at, "hold_s": hold},
        )
        corners = np.linspace(0, count - 1, len(levels))
        ramp = {"amplitude": size, "bias": limits.middle, "period_s": seconds}
        yield "slow-ramp", np.interp(np.arange(count), corners, levels), ramp


def _through(levels: FloatArray, limits: Limits, part: float = 1.0) -> FloatArray:
    """Hold levels for equal times, moving between them at a part of the rate."""
    # Corners of the path, in samples: where a move begins, and where it ends.
    count = len(limits.time)
    hold, step = count / len(levels), part * limits.rate * limits.dt
    corners, values, at = [], [], 0.0
    for place, level in enumerate(levels):
        move = min(max(level - at, -step * hold), step * hold)
        corners += [place * hold, place * hold + abs(move) / step]
        values += [at, at + move]
        at += move
    return np.asarray(np.interp(np.arange(count), corners, values))
