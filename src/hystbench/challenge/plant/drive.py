"""The drive: delay, amplifier and coil, eddy currents. Signals are currents in A."""

import numpy as np

from hystbench.challenge import kernels
from hystbench.challenge.plant.kind import Parameters, PlantRun
from hystbench.record import FloatArray

#: Layers of the cross-section, or lags, in which the diffusion is solved.
LAYERS = 40


def delay(time: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Take the command when it was issued: the excitation is known at any time."""
    return time - p["delay_s"]


def lag(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Coil of inductance and resistance: ``tau dv/dt = z - v``."""
    return kernels.run("hc_lag", run.dt, p["time_constant_s"], over=z)


def slab(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Mean field in a slab, ``tau dh/dt = d2h/dx2`` with the field given outside."""
    return kernels.run("hc_diffusion", LAYERS, 0, run.dt, p["time_constant_s"], over=z)


def rod(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Mean field in a round rod, the same in cylinder coordinates."""
    return kernels.run("hc_diffusion", LAYERS, 1, run.dt, p["time_constant_s"], over=z)


def square_root(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Follow as ``(1 + s tau)^-1/2``, the mean of lags ``1 / (1 + s tau sin(a)^2)``.

    The mean is over angles ``a`` from 0 to a right angle; at high frequencies the
    response falls by 10 dB a decade, at 45 degrees.
    """
    angles = (np.arange(LAYERS) + 0.5) * 0.5 * np.pi / LAYERS
    lags = [
        # what is shorter than half a step, Runge-Kutta cannot follow, nor can the grid
        kernels.run("hc_lag", run.dt, time, over=z) if time > 0.5 * run.dt else z
        for time in p["time_constant_s"] * np.sin(angles) ** 2
    ]
    return np.asarray(np.mean(lags, axis=0))


def clip(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Limit the current at the amplifier's supply."""
    return np.clip(z, -p["limit"], p["limit"])


def soft_clip(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Limit the current round the corner: ``z / (1 + |z / limit|^8)^(1/8)``."""
    return z / (1.0 + np.abs(z / p["limit"]) ** 8) ** 0.125


def slew(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Limit the rate of the current."""
    return kernels.run("hc_slew", p["rate"] * run.dt, over=z)


def dead_zone(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Give no current near zero: crossover of a push-pull stage."""
    return z - np.clip(z, -p["half_width"], p["half_width"])


def rounded_dead_zone(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Give little current near zero, with rounded corners: ``z - w tanh(z / w)``."""
    return z - p["half_width"] * np.tanh(z / p["half_width"])
