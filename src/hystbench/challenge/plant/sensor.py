"""The sensor: lag, nonlinearity, pickup, drift, calibration. Signals are in um."""

from typing import Any

import numpy as np

from hystbench.challenge.plant.kind import Parameters, PlantRun
from hystbench.record import FloatArray

#: Cosines of a drift path and the band they lie in, in Hz.
PATH_COSINES, PATH_BAND = 12, (0.005, 0.25)


def polynomial(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Bend the scale by a square and a cube."""
    return z + p["quadratic"] * z**2 + p["cubic"] * z**3


def gap_law(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Read a gap by what goes with its inverse: ``z / (1 - z / gap)``."""
    return z / (1.0 - z / p["gap"])


def sine(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Read an angle's sine in the place of the angle: ``reach * sin(z / reach)``."""
    return np.asarray(p["reach"] * np.sin(z / p["reach"]))


def mains(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Pick up the mains and two harmonics, at a phase that is new in each record."""
    start = run.random.uniform(0.0, 2.0 * np.pi)
    angle = 2.0 * np.pi * p["frequency_hz"] * run.time + start
    out = z + p["amplitude"] * np.sin(angle)
    for harmonic in (2, 3):
        share = p[f"share_{harmonic}"]
        out += p["amplitude"] * share * np.sin(harmonic * angle + harmonic)
    return out


def mains_told(p: Parameters) -> dict[str, Any]:
    """Give the harmonics' amplitudes in the place of shares."""
    shares = (1.0, p["share_2"], p["share_3"])
    return {
        "frequency_hz": p["frequency_hz"],
        "amplitudes": [p["amplitude"] * share for share in shares],
    }


def ramp(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Drift at one rate from each record's start."""
    return z + p["slope"] * run.time


def path(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Drift along a smooth random path, new in each record, from zero."""
    low, high = np.log(PATH_BAND)
    frequency = np.exp(run.random.uniform(low, high, PATH_COSINES))
    phase = run.random.uniform(0.0, 2.0 * np.pi, PATH_COSINES)
    angle = 2.0 * np.pi * frequency[:, None]
    slow = np.cos(angle * run.time[::64] + phase[:, None]).sum(axis=0)
    smooth = np.interp(run.time, run.time[::64], slow)
    scale = p["size"] / np.sqrt(PATH_COSINES / 2.0)
    return np.asarray(z + scale * (smooth - smooth[0]))


def wave(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Drift in a slow wave at a phase that is new in each record, from zero."""
    start = run.random.uniform(0.0, 2.0 * np.pi)
    angle = 2.0 * np.pi * p["frequency_hz"] * run.time + start
    return np.asarray(z + p["size"] * (np.sin(angle) - np.sin(start)))


def calibration(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Read with a wrong scale and zero."""
    return (1.0 + p["gain_error"]) * z + p["offset"]


def calibration_told(p: Parameters) -> dict[str, Any]:
    """Give the gain in the place of its error."""
    return {"gain": 1.0 + p["gain_error"], "offset": p["offset"]}
