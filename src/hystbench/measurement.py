"""A twin measured: a model simulated on a signal, as a record."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from hystbench.errors import InputError
from hystbench.model import Model
from hystbench.record import Record
from hystbench.signals import Signal


def measure(
    excitation: Signal, plant: Model, settings: Mapping[str, Any], place: str
) -> Record:
    """Simulate a model on a signal.

    The record's input is the signal plus ``input_zero_error``, a constant that the
    actuator does not see; the sensor noise is drawn from ``seed`` and the signal's
    name, so that it does not depend on which signals are run.

    Parameters
    ----------
    excitation : Signal
    plant : Model
    settings : mapping
        ``seed`` and ``input_zero_error``.
    place : str
        File of the model, for messages.

    Raises
    ------
    InputError
        If the model's input has another unit than the signal.
    """
    if excitation.unit != plant.input.unit:
        raise InputError(
            f"{place}: input: unit {plant.input.unit!r}; "
            f"expected {excitation.unit!r}, the unit of signal {excitation.name}"
        )
    rng = np.random.default_rng([settings["seed"], *excitation.name.encode()])
    return Record(
        name=excitation.name,
        dt=excitation.dt,
        u=excitation.u + settings["input_zero_error"],
        y=plant.simulate(excitation.u, excitation.dt, rng),
        input=plant.input,
        output=plant.output,
        origin="twin",
    )
