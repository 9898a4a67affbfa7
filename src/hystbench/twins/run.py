"""A calibration from settings to files, and the values that it found as a table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from hystbench.files import write_csv, write_json
from hystbench.model import Model
from hystbench.published.split import CALIBRATION_SIGNALS
from hystbench.signals import make_signal
from hystbench.twins.calibrate import calibrate
from hystbench.twins.constraints import check_stroke, turns
from hystbench.twins.ensemble import equally_good
from hystbench.twins.objective import Objective
from hystbench.twins.plant import UNKNOWNS, make_twin, step_sizes, values_of
from hystbench.twins.search import Fit, Tell
from hystbench.twins.targets import targets

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


def run_calibration(
    job: Mapping[str, Any],
    out: Path,
    tell: Tell = lambda line: None,
) -> Fit:
    """Calibrate the twin and write it, equally good ones and what was reached.

    Parameters
    ----------
    job : mapping
        ``signals`` (a signal's job by name, as of ``hystbench job signal``; the
        calibration signals alone), ``filters`` (each filter's job), ``seed`` of the
        noise, ``starts``, ``search_seed`` and ``twins``.
    out : Path
        Folder for ``gma.yaml``; ``uncertainty/`` with the equally good twins; and
        ``report.json`` with values, step sizes, zero error and noise of the recorded
        input, cost, cells and the turns of the chirp.
    tell : callable
        Told one line of progress at a time.

    Raises
    ------
    InputError
        If a signal is held out, a constraint cannot be met or too few equally good
        twins are found.
    """
    wanted = {aim.signal: aim for aim in targets(job["signals"])}
    # In one order, since sums of residuals in another end at another last digit.
    aims = tuple(wanted[name] for name in CALIBRATION_SIGNALS if name in wanted)
    signals = {
        aim.signal: make_signal(aim.signal, **job["signals"][aim.signal])
        for aim in aims
    }
    objective = Objective(signals, job["filters"], job["seed"])
    best = calibrate(
        objective,
        aims,
        starts=job["starts"],
        seed=job["search_seed"],
        tell=tell,
    )
    twin = make_twin(best.values)
    for name in signals:
        check_stroke(name, objective.record(name, twin, {}).y)
    twin.save(out / f"{twin.name}.yaml")
    options = {"count": job["twins"], "seed": job["search_seed"]}
    for number, other in enumerate(
        equally_good(objective, aims, best, **options, tell=tell), start=1
    ):
        name = f"{twin.name}-{number:02d}"
        like = replace(make_twin(other.values), name=name)
        like.save(out / "uncertainty" / f"{name}.yaml")
    write_json(
        out / "report.json",
        {
            "cost": best.cost,
            "values": best.values,
            "convergence_factor": step_sizes(best.values),
            "input_zero_error": best.values["input zero"],
            "input_noise": best.values["input noise"],
            "cells": asdict(objective.cells(best.values, signals)),
            "targets": [asdict(aim) for aim in aims],
            "chirp": turns(twin)._asdict(),
        },
    )
    return best


def write_found(path: str | Path, best: Model, others: Sequence[Model]) -> None:
    """Write a row for each unknown of the twin.

    ``value`` is the best twin's; ``twins_low`` and ``twins_high`` are the least and
    the greatest over it and the equally good ones.
    """
    found = [values_of(model) for model in (best, *others)]
    rows = []
    for item in UNKNOWNS:
        if item.name in found[0]:
            own = [values[item.name] for values in found]
            numbers = (own[0], min(own), max(own), item.low, item.high)
            told = [f"{number:.4g}" for number in numbers]
            rows.append([item.name, item.unit, *told, item.meaning])
    write_csv(path, COLUMNS, rows)
