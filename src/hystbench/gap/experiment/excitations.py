"""Excitations that an experiment could use, within what the actuator bears."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from hystbench.files import atomic_path
from hystbench.gap.experiment.limits import Limits
from hystbench.record import Channel, FloatArray
from hystbench.signals import Signal
from hystbench.waveforms.chirp import Chirp
from hystbench.waveforms.sine import Sine
from hystbench.waveforms.sum_of_sines import SumOfSines

#: Samples of a candidate: enough to tell two models apart.
LONGEST = 20_000
#: Periods without which a sine has not settled.
PERIODS = 3
FREQUENCIES = 12
AMPLITUDES = (0.25, 0.5, 1.0)
BIASES = 5


#: Value and unit by name: all that makes an excitation.
Parameters = dict[str, tuple[float | list[float], str]]


@dataclass(frozen=True, repr=False)
class Excitation:
    """An input that could be tried.

    Parameters
    ----------
    kind : str
    parameters : dict of str to (value, unit)
        All that makes it.
    dt : float
        Sampling interval in seconds.
    u : ndarray, shape (n,)
    """

    kind: str
    parameters: Parameters
    dt: float
    u: FloatArray

    @property
    def words(self) -> str:
        """Kind and parameters, as in ``sine (frequency 40 Hz, amplitude 2 A)``."""
        told = ", ".join(
            f"{_plain(name)} {_number(value)} {unit}".rstrip()
            for name, (value, unit) in self.parameters.items()
        )
        return f"{self.kind.replace('-', ' ')} ({told})"


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
    made = [*_sines(limits, unit), *_wide_bands(limits, unit), *_slow(limits, unit)]
    found = [item for item in made if _feasible(item, limits)]
    if limits.duration_s > LONGEST * limits.dt:
        # What is slow is sampled more coarsely, so that it lasts as long as it may.
        coarse = replace(limits, dt=limits.duration_s / LONGEST)
        found += [item for item in _slow(coarse, unit) if _feasible(item, coarse)]
    return tuple(found)


def write_experiment(
    excitation: Excitation, channel: Channel, path: str | Path
) -> None:
    """Write an excitation as a signal file.

    A table of time in seconds and the input, its column named as those of datasets are;
    or, by a path that ends in ``.npz``, an archive as the workflow's signals are, which
    ``hystbench simulate`` runs a model on.

    Parameters
    ----------
    excitation : Excitation
    channel : Channel
        The input's.
    path : str or Path
        Written whole or not at all.
    """
    if Path(path).suffix == ".npz":
        made = Signal("next-experiment", excitation.dt, excitation.u, channel.unit)
        made.save(path)
        return
    unit = channel.unit.replace("/", "_per_")
    name = f"{channel.name.replace(' ', '_')}_{unit}"
    time = np.arange(len(excitation.u)) * excitation.dt
    with atomic_path(path) as temporary, temporary.open("w", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["time_s", name])
        writer.writerows(
            (f"{t:.9g}", f"{value:.9g}")
            for t, value in zip(time, excitation.u, strict=True)
        )


def _feasible(item: Excitation, limits: Limits) -> bool:
    slack = 1e-6 * (limits.high - limits.low)
    within = limits.low - slack <= item.u.min() and item.u.max() <= limits.high + slack
    steps = np.abs(np.diff(item.u))
    fast = float(steps.max()) > limits.rate * limits.dt * (1 + 1e-6)
    return bool(within and not fast and steps.max() > 0)


def _common(limits: Limits) -> dict[str, float]:
    return {
        "duration_s": min(limits.duration_s, LONGEST * limits.dt),
        "sampling_frequency_hz": 1 / limits.dt,
    }


def _ranges(limits: Limits) -> tuple[float, float]:
    """Middle and half width of the input's range."""
    middle, half = (limits.high + limits.low) / 2, (limits.high - limits.low) / 2
    return (0.0 if abs(middle) < 1e-9 * half else middle), half


def _frequencies(limits: Limits) -> FloatArray:
    """From a few periods in a record to the bandwidth, equal ratios apart."""
    lowest = PERIODS / _common(limits)["duration_s"]
    highest = min(limits.bandwidth_hz, 0.2 / limits.dt)
    if highest <= lowest:
        return np.array([lowest])
    return np.geomspace(lowest, highest, FREQUENCIES)


def _sines(limits: Limits, unit: str) -> Iterator[Excitation]:
    middle, half = _ranges(limits)
    common = _common(limits)
    for frequency in map(float, _frequencies(limits)):
        most = min(half, limits.rate / (2 * np.pi * frequency))
        for part in AMPLITUDES:
            amplitude = part * most
            u = middle + Sine.samples(
                frequency_hz=frequency, amplitude=amplitude, **common
            )
            about: Parameters = {
                "frequency_hz": (frequency, "Hz"),
                "amplitude": (amplitude, unit),
                "bias": (middle, unit),
            }
            yield _made("sine", about, limits, u)
        # half of the rate moves between levels, half is left for the loops
        amplitude = min(half / BIASES, most / 2)
        levels = np.linspace(-1, 1, BIASES) * (half - amplitude)
        u = middle + _minor_loops(frequency, amplitude, levels, limits)
        about = {
            "frequency_hz": (frequency, "Hz"),
            "amplitude": (amplitude, unit),
            "bias_levels": ((middle + levels).tolist(), unit),
        }
        yield _made("biased-minor-loops", about, limits, u)


def _minor_loops(
    frequency_hz: float, amplitude: float, levels: FloatArray, limits: Limits
) -> FloatArray:
    """Small sines on top of levels."""
    common = _common(limits)
    count = round(common["duration_s"] / limits.dt)
    path = _through(levels, count, limits, part=0.5)
    loops = Sine.samples(frequency_hz=frequency_hz, amplitude=1.0, **common)
    return np.asarray(path + amplitude * loops[: len(path)])


def _through(
    levels: FloatArray, count: int, limits: Limits, part: float = 1.0
) -> FloatArray:
    """Hold levels for equal times, moving between them at a part of the rate."""
    # corners of the path, in samples: where a move begins, and where it ends
    hold, step = count / len(levels), part * limits.rate * limits.dt
    corners, values, at = [], [], 0.0
    for place, level in enumerate(levels):
        move = min(max(level - at, -step * hold), step * hold)
        corners += [place * hold, place * hold + abs(move) / step]
        values += [at, at + move]
        at += move
    return np.asarray(np.interp(np.arange(count), corners, values))


def _wide_bands(limits: Limits, unit: str) -> Iterator[Excitation]:
    middle, half = _ranges(limits)
    common = _common(limits)
    frequencies = _frequencies(limits)
    low, high = float(frequencies[0]), float(frequencies[-1])
    amplitude = min(half, limits.rate / (2 * np.pi * high))
    about: Parameters = {"from_hz": (low, "Hz"), "to_hz": (high, "Hz")}
    u = Chirp.samples(from_hz=low, to_hz=high, amplitude=amplitude, **common)
    about |= {"amplitude": (amplitude, unit), "bias": (middle, unit)}
    yield _made("chirp", about, limits, middle + u)
    raw = SumOfSines.samples(
        frequencies_hz=frequencies.tolist(),
        amplitudes=[1.0] * len(frequencies),
        gain=1.0,
        **common,
    )
    fastest = float(np.abs(np.diff(raw)).max()) / limits.dt
    each = min(half / float(np.abs(raw).max()), limits.rate / fastest)
    about = {
        "frequencies_hz": (frequencies.tolist(), "Hz"),
        "amplitude_each": (each, unit),
        "bias": (middle, unit),
    }
    yield _made("multisine", about, limits, middle + each * raw)


def _slow(limits: Limits, unit: str) -> Iterator[Excitation]:
    middle, half = _ranges(limits)
    count = round(_common(limits)["duration_s"] / limits.dt)
    for part in AMPLITUDES:
        levels = part * half * np.array([0.0, 1.0, 0.0, -1.0, 0.0])
        about: Parameters = {
            "levels": ((middle + levels).tolist(), unit),
            "hold_s": (count * limits.dt / len(levels), "s"),
        }
        u = middle + _through(levels, count, limits)
        yield _made("steps-with-holds", about, limits, u)
        corners = np.linspace(0, count - 1, 5)
        u = middle + np.interp(np.arange(count), corners, levels)
        about = {
            "amplitude": (part * half, unit),
            "bias": (middle, unit),
            "period_s": (count * limits.dt, "s"),
        }
        yield _made("slow-ramp", about, limits, u)


def _made(
    kind: str,
    about: Parameters,
    limits: Limits,
    u: FloatArray,
) -> Excitation:
    parameters = {**about, "duration_s": (len(u) * limits.dt, "s")}
    return Excitation(kind, parameters, limits.dt, np.ascontiguousarray(u))


def _plain(name: str) -> str:
    """Name of a parameter without its unit."""
    return name.removesuffix("_hz").removesuffix("_s").replace("_", " ")


def _number(value: float | list[float]) -> str:
    if isinstance(value, list):
        return ", ".join(f"{item:.3g}" for item in value)
    return f"{value:.3g}"
