"""The mechanics: modes, friction, a loose joint, creep and heat. Signals are in um."""

from typing import Any

import numpy as np

from hystbench.challenge import kernels
from hystbench.challenge.plant.kind import Parameters, PlantRun
from hystbench.record import FloatArray


def oscillate(
    z: FloatArray, dt: float, frequency_hz: float, damping_ratio: float, alpha: float
) -> FloatArray:
    """Move a mass on a spring, ``x'' = wn^2 (z - x - alpha x^3) - 2 zeta wn x'``."""
    omega = 2.0 * np.pi * frequency_hz
    return kernels.run("hc_oscillator", dt, omega, damping_ratio, alpha, over=z)


def mode(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Add a mode that carries a part of the displacement, of whatever stiffness."""
    alpha = p.get("coefficient", 0.0)
    x = oscillate(z, run.dt, p["frequency_hz"], p["damping_ratio"], alpha)
    share = p["participation"]
    return (1.0 - share) * z + share * x


def coulomb(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Add dry friction, smooth about rest by tanh."""
    speed = np.gradient(run.u, run.dt) / p["velocity_scale"]
    return z + p["coulomb"] * np.tanh(speed)


def coulomb_algebraic(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Add dry friction, smooth about rest by ``x / sqrt(1 + x^2)``."""
    speed = np.gradient(run.u, run.dt) / p["velocity_scale"]
    return z + p["coulomb"] * speed / np.sqrt(1.0 + speed**2)


def coulomb_arctangent(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Add dry friction, smooth about rest by the arctangent."""
    speed = np.gradient(run.u, run.dt) / p["velocity_scale"]
    return z + p["coulomb"] * (2.0 / np.pi) * np.arctan(speed)


def joint(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Carry the load by a pin in a slot."""
    return kernels.run("hc_joint", p["half_width"], over=z)


def kelvin_voigt(
    z: FloatArray, dt: float, magnitudes: list[float], times: list[float]
) -> FloatArray:
    """Add springs in parallel with dashpots: ``tau_j e_j' = m_j z - e_j``, summed."""
    total = z.copy()
    for magnitude, time in zip(magnitudes, times, strict=True):
        total += magnitude * kernels.run("hc_lag", dt, time, over=z)
    return total


def creep_told(p: Parameters) -> dict[str, Any]:
    """Give the elements of creep: one, or three of equal magnitude."""
    count = 1 if "ratio" not in p else 3
    return {
        "magnitudes": [p["magnitude"] / count] * count,
        "time_constants_s": [
            p["time_constant_s"] * p.get("ratio", 1.0) ** k for k in range(count)
        ],
    }


def creep(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Creep by one Kelvin-Voigt element or by three."""
    told = creep_told(p)
    return kelvin_voigt(z, run.dt, told["magnitudes"], told["time_constants_s"])


def heat(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Warm the rod by the current's square and lose it: ``tau T' = u^2 - T``."""
    warmth = kernels.run("hc_lag", run.dt, p["time_constant_s"], over=run.u**2)
    return z + p["coefficient"] * warmth


def heat_of_the_coil(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Warm a coil by the current's square, and the rod by the coil."""
    times = p["coil"] * p["time_constant_s"], p["time_constant_s"]
    coil = kernels.run("hc_lag", run.dt, times[0], over=run.u**2)
    return z + p["coefficient"] * kernels.run("hc_lag", run.dt, times[1], over=coil)


def fractional(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Relax over five decades at once, as ``s^-order`` does (Oustaloup's spread)."""
    times = np.logspace(-2.7, 2.3, 11)
    shares = times ** (p["order"] - 0.5)
    magnitudes = p["magnitude"] * shares / shares.sum()
    return kelvin_voigt(z, run.dt, list(magnitudes), list(times))
