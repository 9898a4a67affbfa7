"""What is free in the twin, and the model file that the values make."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hystbench.envelope import PUBLISHED_ENVELOPE, thresholds
from hystbench.model import Model
from hystbench.record import FloatArray

ORDER = 30
AMPLITUDE = 0.632  # A, section 4

STEP_NAMES = {
    "gpo": {"mu": "gpo step"},
    "backlash": {"mu": "backlash step"},
    "volterra": {
        "first_order": "volterra first step",
        "second_order": "volterra second step",
    },
    "delayed": {"mu": "delayed step"},
}
"""The step sizes of each filter, as config.yaml names them, and their unknowns."""


@dataclass(frozen=True)
class Unknown:
    """A number that calibration may choose.

    Parameters
    ----------
    name, unit : str
    start, low, high : float
        Where the search starts and what bounds it.
    logarithmic : bool
        Whether the search moves in the logarithm.
    meaning : str
        What it is in the twin, and why the bounds.
    """

    name: str
    unit: str
    start: float
    low: float
    high: float
    logarithmic: bool
    meaning: str


BASE_UNKNOWNS = (
    Unknown("gain", "um", 94, 20, 400, True, "sum of the weights of the operators"),
    Unknown("first", "-", 0.47, 0.02, 0.98, False, "share of the first operator"),
    Unknown("decay", "-", -2.1, -8, 8, False, "others go as exp(-decay i / (N + 1))"),
    Unknown("zero", "Hz", 1900, 20, 5000, True, "zero of the eddy-current lag"),
    Unknown("pole", "Hz", 166, 10, 2000, True, "pole of the eddy-current lag"),
    Unknown("mode", "Hz", 63, 60, 70, False, "first mode; 69.7 Hz seen in a sweep"),
    Unknown("damping", "-", 0.011, 0.003, 0.15, True, "damping ratio of the mode"),
    Unknown(
        "participation", "-", -0.0044, -0.3, 0.3, False, "static share of the mode"
    ),
    Unknown("asymmetry", "1/um", -6e-4, -0.02, 0.02, False, "square before the lag"),
    Unknown("offset", "um", -0.2, -2, 2, False, "sensor's zero"),
    Unknown("noise", "um", 0.021, 0.003, 0.15, True, "RMS of the sensor noise"),
    Unknown(
        "input zero", "A", -0.0057, -0.03, 0.03, False, "recorded minus true input"
    ),
    Unknown("gpo step", "-", 2.1, 0.05, 20, True, "convergence factor"),
    Unknown("backlash step", "-", 0.13, 0.01, 3, True, "convergence factor"),
    Unknown("volterra first step", "-", 0.0031, 1e-4, 0.2, True, "convergence factor"),
    Unknown(
        "volterra second step", "-", 2.7e-4, 1e-5, 0.02, True, "convergence factor"
    ),
    Unknown("delayed step", "-", 0.02, 1e-3, 0.3, True, "convergence factor"),
)
"""Those of the base structure, from which the others that were tried set out."""
INPUT_NOISE = Unknown("input noise", "A", 1e-3, 1e-4, 0.02, True, "RMS, white")
UNKNOWNS = (*BASE_UNKNOWNS, INPUT_NOISE)
"""Those of the structure that was chosen (plants/choice.yaml)."""


def weights(gain: float, first: float, decay: float) -> FloatArray:
    """Weights of the play operators: a share for the first, the rest exponential."""
    rest = np.exp(-decay * np.arange(1, ORDER + 1) / (ORDER + 1))
    return np.concatenate(([gain * first], gain * (1 - first) * rest / rest.sum()))


def make_twin(values: dict[str, float]) -> Model:
    """Make the twin's model from the values of the unknowns.

    Parameters
    ----------
    values : dict of str to float
        By the names of :data:`UNKNOWNS`; step sizes, and the zero error and the noise
        of the recorded input, are no part of the model and are left aside.
    """
    fitted = "Fitted to the published errors and implied RMS of eight signals"
    sweep = f"{fitted}, held to the times of the chirp in the text."
    lag = f"{fitted}; pole at {values['pole']:.4g} Hz, zero at {values['zero']:.4g} Hz."
    content = {
        "name": "gma",
        "input": {"name": "current", "unit": "A"},
        "output": {"name": "displacement", "unit": "um"},
        "chain": [
            {
                "gpi": {
                    "envelope": PUBLISHED_ENVELOPE.to_dict(),
                    "thresholds": _rounded(
                        thresholds(PUBLISHED_ENVELOPE, AMPLITUDE, ORDER)
                    ),
                    "weights": _rounded(
                        weights(values["gain"], values["first"], values["decay"])
                    ),
                }
            },
            {"asymmetry": {"coefficient": _round(values["asymmetry"])}},
            {
                "transfer-function": {
                    "numerator": [*_rounded([_lag(values["zero"])]), 1.0],
                    "denominator": [*_rounded([_lag(values["pole"])]), 1.0],
                }
            },
            {
                "resonance": {
                    "frequency_hz": _round(values["mode"]),
                    "damping_ratio": _round(values["damping"]),
                    "participation": _round(values["participation"]),
                }
            },
            {"calibration-error": {"gain": 1.0, "offset": _round(values["offset"])}},
            {"sensor-noise": {"rms": _round(values["noise"])}},
        ],
        "provenance": {
            name: {"source": source, "note": note}
            for name, source, note in (
                ("gpi.envelope", "published", "Section 4, from a 1 Hz sine."),
                ("gpi.thresholds", "derived", "Eq. 10 with N = 30 at 0.632 A."),
                ("gpi.weights", "calibrated", f"{fitted}."),
                ("asymmetry.coefficient", "calibrated", f"{fitted}."),
                ("transfer-function.numerator", "calibrated", lag),
                ("transfer-function.denominator", "calibrated", lag),
                ("resonance.frequency_hz", "calibrated", sweep),
                ("resonance.damping_ratio", "calibrated", sweep),
                ("resonance.participation", "calibrated", sweep),
                ("calibration-error.gain", "derived", "One: inside the weights."),
                ("calibration-error.offset", "calibrated", f"{fitted}."),
                ("sensor-noise.rms", "calibrated", f"{fitted}."),
            )
        },
    }
    return Model.from_mapping(content, "calibration")


def step_sizes(values: dict[str, float]) -> dict[str, dict[str, float]]:
    """Step sizes by filter, as ``convergence_factor`` of config.yaml wants them."""
    return {
        model: {key: values[name] for key, name in names.items()}
        for model, names in STEP_NAMES.items()
    }


def _lag(frequency_hz: float) -> float:
    return float(1 / (2 * np.pi * frequency_hz))


def _round(value: float) -> float:
    """Round to seven digits: finer than the tables tell, and legible."""
    return float(f"{value:.7g}")


def _rounded(values: FloatArray | list[float]) -> list[float]:
    return [_round(float(value)) for value in values]
