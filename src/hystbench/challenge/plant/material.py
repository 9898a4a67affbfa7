"""The material beside its hysteresis: bias, even terms, saturation, rate."""

import numpy as np

from hystbench.challenge.plant.kind import Parameters, PlantRun
from hystbench.record import FloatArray


def bias(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Add the constant field of a magnet that is off its nominal place."""
    return z + p["bias"]


def square(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Add an even term to the strain."""
    return z + p["coefficient"] * z**2


def exponential(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Strain one way more than the other: ``(exp(c z) - 1) / c``."""
    return np.asarray(np.expm1(p["coefficient"] * z) / p["coefficient"])


def excess_field(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Lose to moving domain walls a field that grows with the rate (Bertotti 1988)."""
    speed = np.gradient(z, run.dt)
    speed[0] = 0.0  # at rest, so that what it loses there is no bias
    return z - p["coefficient"] * np.abs(speed) ** p["exponent"] * np.sign(speed)


def growth(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Factor on the thresholds of the plays, from the field that enters them."""
    speed = np.abs(np.gradient(z, run.dt))
    return 1.0 + p["coefficient"] * speed ** p["exponent"]


def hyperbolic(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Saturate as ``level * tanh(z / level)``."""
    return p["level"] * np.tanh(z / p["level"])


def algebraic(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Saturate as ``z / (1 + |z / level|^n)^(1/n)``, sharper the larger n is."""
    ratio = np.abs(z / p["level"]) ** p["sharpness"]
    return z / (1.0 + ratio) ** (1.0 / p["sharpness"])


def arctangent(z: FloatArray, run: PlantRun, p: Parameters) -> FloatArray:
    """Saturate as ``level * arctan(z / level)``."""
    return np.asarray(p["level"] * np.arctan(z / p["level"]))
