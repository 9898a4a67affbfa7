"""The drive: delay, amplifier and coil, eddy currents. Signals are currents in A."""

import numpy as np

from hystbench.challenge import kernels
from hystbench.challenge.plant.kind import Parameters, Run
from hystbench.record import FloatArray

#: Layers of the cross-section in which the diffusion is solved.
CELLS = 40


def delay(time: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Take the command when it was issued: the excitation is known at any time."""
    return time - p["delay_s"]


def lag(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Coil of inductance and resistance: ``tau dv/dt = z - v``."""
    return kernels.run("hc_lag", run.dt, p["time_constant_s"], over=z)


def slab(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Mean field in a slab, ``tau dh/dt = d2h/dx2`` with the field given outside."""
    return kernels.run("hc_diffusion", CELLS, 0, run.dt, p["time_constant_s"], over=z)


def rod(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Mean field in a round rod, the same in cylinder coordinates."""
    return kernels.run("hc_diffusion", CELLS, 1, run.dt, p["time_constant_s"], over=z)


def clip(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Limit the current at the amplifier's supply."""
    return np.clip(z, -p["limit"], p["limit"])


def slew(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Limit the rate of the current."""
    return kernels.run("hc_slew", p["rate"] * run.dt, over=z)


def dead_zone(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Give no current near zero: crossover of a push-pull stage."""
    return z - np.clip(z, -p["half_width"], p["half_width"])
