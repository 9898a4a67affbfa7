"""What calibration found, read back from the model files: values, spread and bounds."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from hystbench.calibration.twin import ORDER, UNKNOWNS
from hystbench.files import write_csv
from hystbench.model import Model

COLUMNS = (
    "unknown",
    "unit",
    "value",
    "twins_low",
    "twins_high",
    "lower_bound",
    "upper_bound",
    "meaning",
)


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


def write_found(path: str | Path, best: Model, others: Sequence[Model]) -> None:
    """Write a row for each unknown of the twin.

    ``value`` is the best twin's; ``twins_low`` and ``twins_high`` are the least and
    the greatest over it and the equally good ones.
    """
    found = [values_of(model) for model in (best, *others)]
    rows = []
    for item in UNKNOWNS:
        if item.name in found[0]:
            all_values = [values[item.name] for values in found]
            numbers = (
                all_values[0],
                min(all_values),
                max(all_values),
                item.low,
                item.high,
            )
            told = [f"{number:.4g}" for number in numbers]
            rows.append([item.name, item.unit, *told, item.meaning])
    write_csv(path, COLUMNS, rows)
