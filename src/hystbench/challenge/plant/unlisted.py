"""Physics that the vocabulary has no word for: the right answer is "unnamed"."""

import numpy as np

from hystbench.challenge import kernels
from hystbench.challenge.plant.kind import Parameters, PlantRun
from hystbench.record import FloatArray


def capacitive(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Pick up the drive's slope through stray capacitance: ``c du/dt``."""
    return z + p["coupling"] * np.gradient(run.u, run.dt)


def warm_gain(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Lose gain as Joule heat warms the material."""
    warmth = kernels.run("hc_lag", run.dt, p["time_constant_s"], over=run.u**2)
    return z * (1.0 - p["coefficient"] * warmth)


def telegraph(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Jump between two readings at random: a bad contact."""
    flips = run.random.uniform(size=len(z)) < run.dt * p["rate"]
    return z + p["height"] * (np.cumsum(flips) % 2)


def multiplicative(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Read through a gain that flickers (first-order random process)."""
    steps = run.random.standard_normal(len(z))
    # unit variance after a first-order low-pass of this time constant
    steps *= np.sqrt(2.0 * p["time_constant_s"] / run.dt)
    flicker = kernels.run("hc_lag", run.dt, p["time_constant_s"], over=steps)
    return z * (1.0 + p["coefficient"] * flicker)


def held(y: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Hold the last sample now and then: a bus that drops words."""
    begins = run.random.uniform(size=len(y)) < p["probability"]
    lost = np.convolve(begins, np.ones(round(p["samples"])))[: len(y)] > 0
    lost[0] = False
    place = np.where(lost, 0, np.arange(len(y)))
    return y[np.maximum.accumulate(place)]


def hum_gain(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Modulate the gain by the mains: ripple of the amplifier's supply."""
    start = run.random.uniform(0.0, 2.0 * np.pi)
    angle = 2.0 * np.pi * p["frequency_hz"] * run.time + start
    return z * (1.0 + p["depth"] * np.sin(angle))


def stick_slip(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Stick until the spring pulls hard enough, then slip most of the way."""
    hold = p["hold"]
    rate = 1.0 - np.exp(-run.dt / 5e-4)
    return kernels.run("hc_stick_slip", hold, p["release"] * hold, rate, over=z)


def clock(time: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Take samples by a clock that runs off and trembles."""
    tremble = run.random.standard_normal(len(time)) * p["tremble_s"]
    # a clock of another rate: the file's times are what the clock said
    return np.abs(time * (1.0 + p["rate_error"]) + tremble)


def lazy_delay(time: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Delay that grows with the command's magnitude: a busy converter."""
    return time - p["delay_s"] * np.abs(run.u) / 0.6


def hysteretic_sensor(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Strain gauge whose glue slips: rate-independent stops beside the reading."""
    out = z.copy()
    for share in (0.3, 0.6, 1.0):
        carried = kernels.run("hc_joint", share * p["half_width"], over=z**2 / 20.0)
        out += p["weight"] / 3.0 * carried
    return out


def fatigue(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Give way the more, the longer the way gone: a joint that settles in."""
    gone = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(z)))])
    return np.asarray(z * (1.0 - p["depth"] * -np.expm1(-gone / p["way"])))


def coarse(y: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Round to a converter of few bits."""
    return np.round(y / p["step"]) * p["step"]
