"""Errors that stay far off, under what could explain them: run, not fitted.

Nothing here is chosen: each row says what the twin gives with one thing changed, beside
what the paper prints.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hystbench.adaptive import make_filter
from hystbench.metrics import mean_square_error
from hystbench.model import Model
from hystbench.record import Record
from hystbench.twins.read import Twin
from hystbench.twins.runs import (
    Settings,
    draw_signals,
    filter_jobs,
    measure_twin,
    run_all,
    run_records,
    scaled,
)

CHIRP = "chirp-1-100hz"
START_UP_S = 0.1
OFFSETS_UM = (0.25, 0.5, 1.0)
"""Constants added to the displacement, within what a sensor's zero may be off."""
DRIFTS_UM = (0.5, 0.75, 1.0)
"""Drifts that die away over the record, evenly from its start to its end."""
FAST = ("sine-100hz", "sine-150hz", "sine-200hz")
VOLTERRA_FACTORS = (0.25, 0.5, 1.0, 2.0, 4.0)
PLANT = {
    "frequency": ("resonance.frequency_hz", (0.97, 1.03)),
    "damping": ("resonance.damping_ratio", (0.5, 2.0, 5.0)),
    "participation": ("resonance.participation", (0.0, 3.0, 10.0)),
}
"""What of the mode is varied: its value in the model, and factors on it."""
SWEEPS = ({"from_hz": 0.5}, {"to_hz": 90}, {"to_hz": 110}, {"duration_s": 4.06})


@dataclass(frozen=True)
class Row:
    """What the filters give with one thing changed.

    Parameters
    ----------
    subject : str
        Which error is to be explained: ``chirp`` or ``volterra``.
    changed : str
        What is changed.
    signal, part : str
        On which signal, and on which part of the record.
    mse : mapping
        MSE (um^2) by filter; infinite where it diverged.
    """

    subject: str
    changed: str
    signal: str
    part: str
    mse: Mapping[str, float]


def chirp_rows(twin: Twin, settings: Settings) -> Iterator[Row]:
    """Vary mode, sweep and constant under the chirp."""

    def run(model: Model, job: Settings, changed: str, extra: Any = None) -> Row:
        signal = draw_signals({CHIRP: job}, 0)[CHIRP]
        other = replace(twin, model=model)
        record = measure_twin(other, [signal], settings["measure"], 0)[CHIRP]
        if extra is not None:
            record = replace(record, y=record.y + extra(record))
        mse = {}
        for name, own in filter_jobs(settings).items():
            runs = run_records(name, own, {CHIRP: record}, {})
            mse[name] = runs[CHIRP, name].error("mse")
        return Row("chirp", changed, CHIRP, "whole record", mse)

    usual = settings["signals"][CHIRP]
    yield run(twin.model, usual, "nothing")
    for name, (place, factors) in PLANT.items():
        for factor in factors:
            value = float(np.asarray(twin.model.value(place))) * factor
            model = twin.model.with_values({place: value})
            yield run(model, usual, f"{name} of the mode times {factor:g}")
    ((kind, given),) = usual["definition"].items()
    for change in SWEEPS:
        job = {**usual, "definition": {kind: {**given, **change}}}
        told = ", ".join(f"{key} {value:g}" for key, value in change.items())
        yield run(twin.model, job, f"sweep with {told}")
    for size in OFFSETS_UM:
        for sign in (1, -1):
            shift = sign * size
            told = f"{shift:+g} um on the displacement"
            yield run(twin.model, usual, told, lambda record, c=shift: c)
    for size in DRIFTS_UM:
        told = f"drift of {size:g} um that dies away"
        yield run(twin.model, usual, told, lambda record, c=size: _drift(record, c))


def _drift(record: Record, size: float) -> Any:
    return size * (1 - np.arange(len(record)) / len(record))


def volterra_rows(twin: Twin, settings: Settings) -> Iterator[Row]:
    """Leave the start-up out, and vary the step sizes, at high frequencies."""
    names = {name: settings["signals"][name] for name in FAST}
    signals = draw_signals(names, 0)
    records = measure_twin(twin, signals.values(), settings["measure"], 0)
    for factor in VOLTERRA_FACTORS:
        job = scaled(settings["filters"]["volterra"], factor)
        filters = [make_filter("volterra", job, r) for r in records.values()]
        found = run_all(list(zip(filters, records.values(), strict=True)))
        for record, result in zip(records.values(), found, strict=True):
            start = round(START_UP_S / record.dt)
            told = f"step sizes times {factor:g}"
            parts = {"whole record": math.inf}
            if result.diverged_at is None:
                parts["whole record"] = mean_square_error(result.error)
                late = mean_square_error(result.error[start:])
                parts[f"after {START_UP_S:g} s"] = late
            for part, value in parts.items():
                yield Row("volterra", told, record.name, part, {"volterra": value})
