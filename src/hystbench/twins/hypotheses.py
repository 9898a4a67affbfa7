"""Errors that stay far off, under what could explain them: run, not fitted.

Nothing here is chosen: each row says what the twin gives with one thing changed, beside
what the paper prints.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from hystbench.adaptive import make_filter
from hystbench.metrics import mean_square_error
from hystbench.model import Model
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


def chirp_rows(
    twin: Twin, settings: Settings
) -> Iterator[tuple[str, dict[str, float]]]:
    """Vary mode, sweep and constant under the chirp.

    Yields
    ------
    (str, dict of str to float)
        What is changed, and the MSE (um^2) by filter; infinite where it diverged.
    """

    def run(
        model: Model,
        job: Settings,
        changed: str,
        constant: float = 0.0,
        drift: float = 0.0,
    ) -> tuple[str, dict[str, float]]:
        signal = draw_signals({CHIRP: job}, 0)[CHIRP]
        other = replace(twin, model=model)
        record = measure_twin(other, [signal], settings["measure"], 0)[CHIRP]
        fading = 1 - np.arange(len(record)) / len(record)
        record = replace(record, y=record.y + constant + drift * fading)
        mse = {}
        for name, own in filter_jobs(settings).items():
            runs = run_records(name, own, {CHIRP: record}, {})
            mse[name] = runs[CHIRP, name].error("mse")
        return changed, mse

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
            told = f"{sign * size:+g} um on the displacement"
            yield run(twin.model, usual, told, constant=sign * size)
    for size in DRIFTS_UM:
        told = f"drift of {size:g} um that dies away"
        yield run(twin.model, usual, told, drift=size)


def volterra_rows(
    twin: Twin, settings: Settings
) -> Iterator[tuple[str, str, dict[str, float]]]:
    """Leave the start-up out, and vary the step sizes, at high frequencies.

    Yields
    ------
    (str, str, dict of str to float)
        What is changed, the part of the record, and the MSE (um^2) of the Volterra
        filter by signal; infinite where it diverged.
    """
    names = {name: settings["signals"][name] for name in FAST}
    signals = draw_signals(names, 0)
    records = measure_twin(twin, signals.values(), settings["measure"], 0)
    parts = {"whole record": 0.0, f"after {START_UP_S:g} s": START_UP_S}
    for factor in VOLTERRA_FACTORS:
        job = scaled(settings["filters"]["volterra"], factor)
        filters = [make_filter("volterra", job, r) for r in records.values()]
        pairs = list(zip(filters, records.values(), strict=True))
        results = dict(zip(records, run_all(pairs), strict=True))
        for part, begin_s in parts.items():
            mse = dict.fromkeys(names, math.inf)
            for name, result in results.items():
                if result.diverged_at is None:
                    late = result.error[round(begin_s / signals[name].dt) :]
                    mse[name] = mean_square_error(late)
            yield f"step sizes times {factor:g}", part, mse
