"""The material beside its hysteresis: bias, even terms, saturation, rate."""

from __future__ import annotations

import numpy as np

from hystbench.challenge.plant.kind import Form, Kind, Parameters, Range, Run
from hystbench.record import FloatArray


def bias(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Add the constant field of a magnet that is off its nominal place."""
    return z + p["bias"]


def square(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Add an even term to the strain."""
    return z + p["coefficient"] * z**2


def excess_field(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Lose to moving domain walls a field that grows with the rate (Bertotti 1988)."""
    speed = np.gradient(z, run.dt)
    speed[0] = 0.0  # at rest, so that what it loses there is no bias
    return z - p["coefficient"] * np.abs(speed) ** p["exponent"] * np.sign(speed)


def growth(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Factor on the thresholds of the plays, from the field that enters them."""
    speed = np.abs(np.gradient(z, run.dt))
    return 1.0 + p["coefficient"] * speed ** p["exponent"]


def hyperbolic(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Saturate as ``level * tanh(z / level)``."""
    return p["level"] * np.tanh(z / p["level"])


def algebraic(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Saturate as ``z / (1 + |z / level|^n)^(1/n)``, sharper the larger n is."""
    ratio = np.abs(z / p["level"]) ** p["sharpness"]
    return z / (1.0 + ratio) ** (1.0 / p["sharpness"])


_LEVEL = Range(25.0, 70.0, "um", shifts=False, least=12.0, most=200.0)
_EXPONENT = Range(0.5, 1.0, "-", shifts=False)

KINDS = (
    Kind("hysteresis", "material", "material", ("branch",), {"loop": Form()}),
    Kind(
        "hysteresis-shape",
        "material",
        "material",
        ("branch", "amplitude"),
        {
            "preisach": Form(),
            "jiles-atherton": Form(),
            "other-gpi": Form(),
        },
    ),
    Kind(
        "asymmetry",
        "material",
        "material",
        ("amplitude",),
        {
            "field-bias": Form(
                bias,
                {"bias": Range(0.02, 0.12, "A", sign=True, most=0.3)},
                "bias",
                stage="field",
            ),
            "even-term": Form(
                square,
                {"coefficient": Range(5e-4, 4e-3, "1/um", sign=True, most=0.012)},
                "coefficient",
            ),
        },
    ),
    Kind(
        "saturation",
        "material",
        "material",
        ("amplitude",),
        {
            "tanh": Form(hyperbolic, {"level": _LEVEL}, "level", power=-2.0),
            "algebraic": Form(
                algebraic,
                {
                    "level": _LEVEL,
                    "sharpness": Range(1.6, 4.0, "-", shifts=False),
                },
                "level",
                power=-2.0,
            ),
        },
    ),
    Kind(
        "rate-dependent-hysteresis",
        "material",
        "threshold",
        ("rate", "frequency", "branch"),
        {
            "growing-thresholds": Form(
                growth,
                {
                    "coefficient": Range(2e-3, 2e-2, "(s/A)^exponent", most=0.3),
                    "exponent": _EXPONENT,
                },
                "coefficient",
            ),
            "excess-field": Form(
                excess_field,
                {
                    "coefficient": Range(2e-4, 2e-3, "A (s/A)^exponent", most=0.03),
                    "exponent": _EXPONENT,
                },
                "coefficient",
                stage="field",
            ),
        },
    ),
)
