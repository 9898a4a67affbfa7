"""Excitation signals of the paper, Section 4, and their kin.

A signal is defined in config.yaml by one kind and its parameters, for example
``sine: {frequency_hz: 40}``. A kind is a :class:`hystbench.waveforms.base.Waveform`.
"""

import inspect
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.errors import InputError, placed, refuse_unknown
from hystbench.files import atomic_path
from hystbench.record import FloatArray
from hystbench.units import plain
from hystbench.waveforms import waveforms
from hystbench.waveforms.base import Waveform
from hystbench.written import check_unchanged


@dataclass(frozen=True)
class Signal:
    """An input sampled uniformly."""

    name: str
    """Name in config.yaml and in every result."""
    dt: float
    """Sampling interval in seconds."""
    u: FloatArray
    """Input in the unit of ``unit``, shape (n,)."""
    unit: str
    """Unit of the input."""

    def __post_init__(self) -> None:
        """Keep a unit in its one spelling."""
        object.__setattr__(self, "unit", plain(self.unit))

    def save(self, path: str | Path) -> None:
        """Write the signal as a NumPy archive, all of it or nothing."""
        with atomic_path(path) as temporary, temporary.open("wb") as stream:
            np.savez(stream, u=self.u, name=self.name, dt=self.dt, unit=self.unit)


def load_signal(path: str | Path) -> Signal:
    """Read a signal that :meth:`Signal.save` wrote.

    Raises
    ------
    InputError
        If it was changed since.
    """
    check_unchanged(path)
    with np.load(path, allow_pickle=False) as archive:
        return Signal(
            name=str(archive["name"]),
            dt=float(archive["dt"]),
            u=archive["u"],
            unit=str(archive["unit"]),
        )


def make_signal(
    name: str,
    definition: Mapping[str, Mapping[str, Any]],
    common: Mapping[str, Any],
    place: str = "config.yaml",
) -> Signal:
    """Make a signal from its definition in config.yaml.

    Parameters
    ----------
    name : str
        The signal's name.
    definition : mapping
        One key, the kind, and its parameters; they win over ``common``.
    common : mapping
        Values for the parameters that the definition leaves out, and the ``unit``.
    place : str
        Name of the file, for messages.

    Raises
    ------
    InputError
        If the kind or a parameter is unknown, one is missing or of a wrong value, a
        frequency is not below half the sampling frequency, or the signal does not move.
    """
    where = f"{place}: excitations: {name}"
    ((kind, given),) = definition.items()
    known = waveforms(kind)
    refuse_unknown(kind, known, f"{where}: unknown kind {kind!r}")
    waveform = known[kind]
    parameters = inspect.signature(waveform.samples).parameters
    for key in given:
        refuse_unknown(key, parameters, f"{where}: unknown key {key!r}")
    values = {key: common[key] for key in parameters if key in common} | dict(given)
    for key, parameter in parameters.items():
        if key not in values:
            raise InputError(f"{where}: {kind} misses the key {key!r}")
        # Of a module whose annotations are no text, the name comes with its module.
        told = inspect.formatannotation(parameter.annotation).strip("'")
        annotation = told.rpartition(".")[2]
        _check_value(f"{where}: {key}", key, values[key], annotation, waveform)
    nyquist = values["sampling_frequency_hz"] / 2
    for key, value in values.items():
        if key.endswith("_hz") and key != "sampling_frequency_hz":
            highest = max(value) if isinstance(value, list) else value
            if highest >= nyquist:
                raise InputError(
                    f"{where}: {key}: {highest:g}; expected below {nyquist:g} Hz, "
                    "half the sampling frequency"
                )
    with placed(f"{where}: "):
        u = waveform.samples(**values)
    if len(u) < 2 or np.ptp(u) == 0:
        raise InputError(
            f"{where}: {len(u)} samples that do not move; expected a signal"
        )
    return Signal(name, 1 / values["sampling_frequency_hz"], u, common["unit"])


def _check_value(
    place: str, key: str, value: object, annotation: str, waveform: type[Waveform]
) -> None:
    """Refuse what is not of the parameter's type, or no frequency or count."""
    numbers = value if annotation == "Sequence[float]" else [value]
    types = (int,) if annotation == "int" else (int, float)
    if not isinstance(numbers, list) or not all(
        type(number) in types and np.isfinite(number) for number in numbers
    ):
        expected = {"int": "a whole number", "float": "a finite number"}
        told = expected.get(annotation, "a list of finite numbers")
        raise InputError(f"{place}: {value!r}; expected {told}")
    above_zero = 1 if annotation == "int" else np.nextafter(0, 1)
    least = 0 if key in waveform.may_be_zero else above_zero
    if key not in waveform.any_sign and any(number < least for number in numbers):
        more = "0 or more" if least == 0 else "1 or more" if least == 1 else "above 0"
        raise InputError(f"{place}: {value!r}; expected {more}")
