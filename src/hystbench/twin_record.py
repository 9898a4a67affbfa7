"""A record of the twin: its model simulated on a signal, with noise."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from hystbench.errors import InputError
from hystbench.model import Model
from hystbench.record import Record
from hystbench.signals import Signal


def record_of_twin(
    signal: Signal, plant: Model, settings: Mapping[str, Any], place: str
) -> Record:
    """Simulate a model on a signal.

    The record's input is the signal plus ``input_zero_error``, a constant, and white
    noise of the RMS ``input_noise``; the actuator sees neither. The sensor noise and
    that of the input are drawn from ``seed`` and the signal's name, each from a stream
    of its own, so that they do not depend on which signals are run.

    Parameters
    ----------
    signal : Signal
    plant : Model
    settings : mapping
        ``seed``, ``input_zero_error`` and ``input_noise``, both in the input's unit.
    place : str
        File of the model, for messages.

    Raises
    ------
    InputError
        If the model's input has another unit than the signal.
    """
    if signal.unit != plant.input.unit:
        raise InputError(
            f"{place}: input: unit {plant.input.unit!r}; "
            f"expected {signal.unit!r}, the unit of signal {signal.name}"
        )
    streams = [settings["seed"], *signal.name.encode()]
    noise = np.random.default_rng([*streams, 1]).standard_normal(len(signal.u))
    recorded = signal.u + settings["input_zero_error"]
    return Record(
        name=signal.name,
        dt=signal.dt,
        u=recorded + settings["input_noise"] * noise,
        y=plant.simulate(signal.u, signal.dt, np.random.default_rng(streams)),
        input=plant.input,
        output=plant.output,
        origin="twin",
    )
