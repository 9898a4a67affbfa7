"""What is free in the twin, and the model file that the values make."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from hystbench.envelope import PUBLISHED_ENVELOPE, thresholds
from hystbench.model import Model
from hystbench.record import FloatArray
from hystbench.twins.search import Unknown, Values
from hystbench.yaml_files import parse_yaml

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


UNKNOWNS = (
    Unknown("gain", "um", 20, 400, True, 94, "sum of the weights of the operators"),
    Unknown("first", "-", 0.02, 0.98, False, 0.47, "share of the first operator"),
    Unknown("decay", "-", -8, 8, False, -2.1, "others go as exp(-decay i / (N + 1))"),
    Unknown("zero", "Hz", 20, 5000, True, 1900, "zero of the eddy-current lag"),
    Unknown("pole", "Hz", 10, 2000, True, 166, "pole of the eddy-current lag"),
    Unknown("mode", "Hz", 60, 70, False, 63, "first mode; 69.7 Hz seen in a sweep"),
    Unknown("damping", "-", 0.003, 0.15, True, 0.011, "damping ratio of the mode"),
    Unknown(
        "participation", "-", -0.3, 0.3, False, -0.0044, "static share of the mode"
    ),
    Unknown("asymmetry", "1/um", -0.02, 0.02, False, -6e-4, "square before the lag"),
    Unknown("offset", "um", -2, 2, False, -0.2, "sensor's zero"),
    Unknown("noise", "um", 0.003, 0.15, True, 0.021, "RMS of the sensor noise"),
    Unknown(
        "input zero", "A", -0.03, 0.03, False, -0.0057, "recorded minus true input"
    ),
    Unknown("gpo step", "-", 0.05, 20, True, 2.1, "convergence factor"),
    Unknown("backlash step", "-", 0.01, 3, True, 0.13, "convergence factor"),
    Unknown("volterra first step", "-", 1e-4, 0.2, True, 0.0031, "convergence factor"),
    Unknown(
        "volterra second step", "-", 1e-5, 0.02, True, 2.7e-4, "convergence factor"
    ),
    Unknown("delayed step", "-", 1e-3, 0.3, True, 0.02, "convergence factor"),
    Unknown("input noise", "A", 1e-4, 0.02, True, 1e-3, "RMS, white"),
)
"""Those of the chain, then those of the experiment: what the recorded input has beside
the actuator's, and the step sizes. Their order fixes which start is drawn for which."""
SHARED = {
    "input zero",
    "input noise",
    *(n for s in STEP_NAMES.values() for n in s.values()),
}
"""Unknowns of the experiment: one value for all twins."""


def weights(gain: float, first: float, decay: float) -> FloatArray:
    """Weights of the play operators: a share for the first, the rest exponential."""
    rest = np.exp(-decay * np.arange(1, ORDER + 1) / (ORDER + 1))
    return np.concatenate(([gain * first], gain * (1 - first) * rest / rest.sum()))


def make_twin(values: Values) -> Model:
    """Make the twin's model from the values of the unknowns.

    Parameters
    ----------
    values : dict of str to float
        By the names of :data:`UNKNOWNS`; step sizes, and the zero error and the noise
        of the recorded input, are no part of the model and are left aside.
    """
    operators = weights(values["gain"], values["first"], values["decay"])
    twin = _unfilled().with_values(
        {
            "gpi.weights": _rounded(operators),
            "asymmetry.coefficient": _round(values["asymmetry"]),
            "transfer-function.numerator": [_round(_lag(values["zero"])), 1.0],
            "transfer-function.denominator": [_round(_lag(values["pole"])), 1.0],
            "resonance.frequency_hz": _round(values["mode"]),
            "resonance.damping_ratio": _round(values["damping"]),
            "resonance.participation": _round(values["participation"]),
            "calibration-error.offset": _round(values["offset"]),
            "sensor-noise.rms": _round(values["noise"]),
        }
    )
    filled = {
        key: replace(item, note=item.note.format(**values))
        for key, item in twin.provenance.items()
    }
    return replace(twin, provenance=filled)


@cache
def _unfilled() -> Model:
    text = files(__package__).joinpath("plant.yaml").read_text(encoding="utf-8")
    steps = thresholds(PUBLISHED_ENVELOPE, AMPLITUDE, ORDER)
    content: dict[str, Any] = parse_yaml(text, "plant.yaml")
    content["chain"][0]["gpi"] = {
        "envelope": PUBLISHED_ENVELOPE.to_dict(),
        "thresholds": _rounded(steps),
        "weights": [1.0] * len(steps),
    }
    return Model.from_mapping(content, "calibration")


def values_of(model: Model) -> dict[str, float]:
    """Read the unknowns from a twin: the inverse of ``make_twin``, to its rounding.

    Step sizes, and the zero error and the noise of the recorded input, are no part of
    a model.
    """

    def first(name: str) -> float:
        return float(np.ravel(np.asarray(model.value(name), dtype=float))[0])

    weights = np.asarray(model.value("gpi.weights"), dtype=float)
    decay = np.log(weights[1] / weights[-1]) * (ORDER + 1) / (ORDER - 1)
    return {
        "gain": float(weights.sum()),
        "first": float(weights[0] / weights.sum()),
        "decay": float(decay),
        "zero": 1 / (2 * np.pi * first("transfer-function.numerator")),
        "pole": 1 / (2 * np.pi * first("transfer-function.denominator")),
        "mode": first("resonance.frequency_hz"),
        "damping": first("resonance.damping_ratio"),
        "participation": first("resonance.participation"),
        "asymmetry": first("asymmetry.coefficient"),
        "offset": first("calibration-error.offset"),
        "noise": first("sensor-noise.rms"),
    }


def step_sizes(values: Values) -> dict[str, dict[str, float]]:
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
