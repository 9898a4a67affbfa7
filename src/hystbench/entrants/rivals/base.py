"""What a rival is given, what it answers, and how gap.json is written of that."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from hystbench.dataset import load_dataset
from hystbench.files import write_json
from hystbench.metrics import rms
from hystbench.model import Model, load_model
from hystbench.record import FloatArray, Record

#: Predicts the output of a record.
Predict = Callable[[Record], FloatArray]


@dataclass(frozen=True)
class Given:
    """A dataset and the model it is held against."""

    name: str
    model: Model
    fit: tuple[Record, ...]
    hold_out: tuple[Record, ...]
    model_file: Path = Path()
    """File from which the model was read."""

    def base(self, record: Record) -> FloatArray:
        """Give the base's output."""
        return self.model.simulate(record.u, record.dt)


@dataclass(frozen=True)
class NamedEffect:
    """An effect that a rival names."""

    name: str
    confidence: float
    cannot_be_told_from: tuple[str, ...] = ()


@dataclass(frozen=True)
class Answer:
    """What a rival says of a dataset."""

    predict: Predict
    """The model that is to close the gap, for the hold-out records."""
    verdict: str = "unnamed"
    reason: str = "Nothing is named."
    named: Sequence[NamedEffect] = ()
    """Effects that are named, in their order."""


class PythonSolver(ABC):
    """A solver in Python.

    A file beside this one, or an installed package, adds one by its ``name``.
    """

    name: ClassVar[str]
    """What ``hystbench rival`` calls it."""

    @abstractmethod
    def answer(self, given: Given) -> Answer:
        """Say what a model lacks beside the fit records of a dataset."""


def read(dataset: Path, model: Path) -> Given:
    """Read what a solver gets.

    Raises
    ------
    InputError
        If a file is not what it should be.
    """
    about = load_dataset(dataset)
    records = [about.read(name) for name in about.record_files]
    return Given(
        about.name,
        load_model(model).with_hold(about.input_hold),
        tuple(record for record in records if record.use == "fit"),
        tuple(record for record in records if record.use == "hold-out"),
        model,
    )


def noise_rms(given: Given) -> float:
    """Estimate the noise from repeated periods; from the residual where none repeat."""
    squares, count = 0.0, 0
    for record in given.fit:
        period = record.period_samples
        # the first period holds the switch-on
        whole = len(record) // period - 1 if period else 0
        if whole >= 2 and period:
            repeats = record.y[-whole * period :].reshape(whole, period)
            squares += float(np.sum((repeats - repeats.mean(axis=0)) ** 2))
            count += (whole - 1) * period
    if count:
        return float(np.sqrt(squares / count))
    return rms(*(record.y - given.base(record) for record in given.fit))


def write(given: Given, answer: Answer, out: Path) -> None:
    """Write gap.json into a folder."""
    before = rms(*(record.y - given.base(record) for record in given.hold_out))
    with np.errstate(over="ignore", invalid="ignore"):
        left = rms(*(record.y - answer.predict(record) for record in given.hold_out))
    floor = noise_rms(given)
    repeats = any(r.period_samples for r in (*given.fit, *given.hold_out))
    method = "repeats" if repeats else "upper-bound"
    above = before**2 - floor**2
    # A model that runs away on a record closes nothing.
    after = left if np.isfinite(left) else None
    explained: float | None = 0.0
    if after is not None:
        explained = (before**2 - after**2) / above if above > 0 else None
    effects = [
        {
            "name": item.name,
            "place": "",
            "parameters": {},
            "confidence": item.confidence,
            "cannot_be_told_from": list(item.cannot_be_told_from),
        }
        for item in answer.named
    ]
    content: dict[str, Any] = {
        "dataset": given.name,
        "model": given.model.name,
        "unit": given.model.output.unit,
        "verdict": answer.verdict,
        "reason": answer.reason,
        "effects": effects,
        "where": [],
        "gap": {
            "before": before,
            "after": after,
            "noise_floor": floor,
            "floor_method": method,
            "explained": explained,
        },
        "ranking": [],
        "next_experiment": None,
    }
    write_json(out / "gap.json", content)
