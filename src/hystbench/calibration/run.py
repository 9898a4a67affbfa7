"""One calibration from settings to files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from hystbench.calibration.constraints import check_stroke, turns
from hystbench.calibration.ensemble import equally_good
from hystbench.calibration.fit import Fit, Tell, calibrate
from hystbench.calibration.objective import Objective
from hystbench.calibration.targets import targets
from hystbench.calibration.twin import make_twin, step_sizes
from hystbench.files import write_json
from hystbench.published.split import CALIBRATION_SIGNALS
from hystbench.signals import make_signal


def run_calibration(
    job: Mapping[str, Any],
    *,
    model: Path,
    uncertainty: Path,
    report: Path,
    state: Path | None = None,
    tell: Tell = lambda line: None,
) -> Fit:
    """Calibrate the twin and write it, equally good ones and what was reached.

    Parameters
    ----------
    job : mapping
        ``signals`` (a signal's job by name, as of ``hystbench job signal``; the
        calibration signals alone), ``filters`` (each filter's job), ``seed`` of the
        noise, ``starts``, ``search_seed`` and ``twins``.
    model : Path
        Model file to write.
    uncertainty : Path
        Folder for the equally good twins' model files.
    report : Path
        JSON to write: values, step sizes, zero error and noise of the recorded input,
        cost, cells and the turns of the chirp.
    state : Path, optional
        Where an interrupted search goes on.
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
        state=state,
        tell=tell,
    )
    twin = make_twin(best.values)
    for name in signals:
        check_stroke(name, objective.record(name, twin, 0.0).y)
    twin.save(model)
    options = {"count": job["twins"], "seed": job["search_seed"]}
    for number, other in enumerate(
        equally_good(objective, aims, best, **options, tell=tell), start=1
    ):
        name = f"{twin.name}-{number:02d}"
        replace(make_twin(other.values), name=name).save(uncertainty / f"{name}.yaml")
    write_json(
        report,
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
