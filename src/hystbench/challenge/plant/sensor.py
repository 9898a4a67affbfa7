"""The sensor: lag, nonlinearity, pickup, drift, calibration. Signals are in um."""

from __future__ import annotations

from typing import Any

import numpy as np

from hystbench.challenge.plant.drive import lag
from hystbench.challenge.plant.kind import Form, Kind, Parameters, Range, Run
from hystbench.record import FloatArray

#: Cosines of a drift path and the band they lie in, in Hz.
PATH_COSINES, PATH_BAND = 12, (0.005, 0.25)


def polynomial(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Bend the scale by a square and a cube."""
    return z + p["quadratic"] * z**2 + p["cubic"] * z**3


def gap_law(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Read a gap by what goes with its inverse: ``z / (1 - z / gap)``."""
    return z / (1.0 - z / p["gap"])


def mains(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Pick up the mains and two harmonics, at a phase that is new in each record."""
    start = run.random.uniform(0.0, 2.0 * np.pi)
    angle = 2.0 * np.pi * p["frequency_hz"] * run.time + start
    out = z + p["amplitude"] * np.sin(angle)
    for harmonic in (2, 3):
        share = p[f"share_{harmonic}"]
        out += p["amplitude"] * share * np.sin(harmonic * angle + harmonic)
    return out


def _mains_told(p: Parameters) -> dict[str, Any]:
    shares = (1.0, p["share_2"], p["share_3"])
    return {
        "frequency_hz": p["frequency_hz"],
        "amplitudes": [p["amplitude"] * share for share in shares],
    }


def ramp(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Drift at one rate from each record's start."""
    return z + p["slope"] * run.time


def path(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Drift along a smooth random path, new in each record, from zero."""
    low, high = np.log(PATH_BAND)
    frequency = np.exp(run.random.uniform(low, high, PATH_COSINES))
    phase = run.random.uniform(0.0, 2.0 * np.pi, PATH_COSINES)
    angle = 2.0 * np.pi * frequency[:, None]
    slow = np.cos(angle * run.time[::64] + phase[:, None]).sum(axis=0)
    smooth = np.interp(run.time, run.time[::64], slow)
    scale = p["size"] / np.sqrt(PATH_COSINES / 2.0)
    return np.asarray(z + scale * (smooth - smooth[0]))


def calibration(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Read with a wrong scale and zero."""
    return (1.0 + p["gain_error"]) * z + p["offset"]


def _calibration_told(p: Parameters) -> dict[str, Any]:
    return {"gain": 1.0 + p["gain_error"], "offset": p["offset"]}


_SHARE = Range(0.05, 0.5, "-", shifts=False)

KINDS = (
    Kind(
        "sensor-lag",
        "sensor",
        "sensor",
        ("frequency", "delay"),
        {
            "first-order": Form(
                lag,
                {"time_constant_s": Range(2e-4, 3e-3, "s", least=5e-5, most=0.03)},
                "time_constant_s",
            )
        },
    ),
    Kind(
        "sensor-nonlinearity",
        "sensor",
        "sensor",
        ("amplitude",),
        {
            "polynomial": Form(
                polynomial,
                {
                    "quadratic": Range(3e-4, 3e-3, "1/um", sign=True, most=0.01),
                    "cubic": Range(5e-6, 1e-4, "1/um^2", sign=True, most=3e-4),
                },
                "quadratic",
            ),
            "gap-law": Form(
                gap_law,
                {"gap": Range(250.0, 1500.0, "um", shifts=False, least=90.0)},
                "gap",
                power=-1.0,
            ),
        },
    ),
    Kind(
        "mains-pickup",
        "sensor",
        "sensor",
        ("unexplained", "frequency"),
        {
            "three-harmonics": Form(
                mains,
                {
                    "frequency_hz": Range(49.9, 50.1, "Hz", shifts=False),
                    "amplitude": Range(0.1, 1.0, "um", most=5.0),
                    "share_2": _SHARE,
                    "share_3": _SHARE,
                },
                "amplitude",
                told=_mains_told,
            )
        },
    ),
    Kind(
        "drift",
        "sensor",
        "sensor",
        ("unexplained", "slow-time"),
        {
            "ramp": Form(
                ramp,
                {"slope": Range(0.01, 0.1, "um/s", sign=True, most=1.0)},
                "slope",
            ),
            "path": Form(path, {"size": Range(0.2, 1.5, "um", most=8.0)}, "size"),
        },
    ),
    Kind(
        "calibration-error",
        "sensor",
        "sensor",
        ("amplitude",),
        {
            "gain-and-offset": Form(
                calibration,
                {
                    "gain_error": Range(0.01, 0.08, "-", sign=True, most=0.3),
                    "offset": Range(0.02, 0.6, "um", sign=True),
                },
                "gain_error",
                told=_calibration_told,
            )
        },
    ),
)
