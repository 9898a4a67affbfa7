"""``hystbench measure``: simulate a model on a signal and record it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
import numpy as np

from hystbench import options
from hystbench.errors import InputError
from hystbench.model import load_model
from hystbench.record import Record
from hystbench.signals import load_signal


@click.command()
@click.argument("signal", type=options.FILE)
@click.option("--model", type=options.FILE, required=True, help="Model file (YAML).")
@options.settings
@options.out
def measure(signal: Path, model: Path, settings: dict[str, Any], out: Path) -> None:
    """Simulate a model on SIGNAL and write the record.

    The record's input is the signal plus ``input_zero_error``, a constant that the
    actuator does not see; the sensor noise is drawn from ``seed`` and the signal's
    name, so that it does not depend on which signals are run.
    """
    excitation = load_signal(signal)
    plant = load_model(model)
    if excitation.unit != plant.input.unit:
        raise InputError(
            f"{model}: input: unit {plant.input.unit!r}; "
            f"expected {excitation.unit!r}, the unit of signal {excitation.name}"
        )
    rng = np.random.default_rng([settings["seed"], *excitation.name.encode()])
    Record(
        name=excitation.name,
        dt=excitation.dt,
        u=excitation.u + settings["input_zero_error"],
        y=plant.simulate(excitation.u, excitation.dt, rng),
        input=plant.input,
        output=plant.output,
        origin="twin",
    ).save(out)
