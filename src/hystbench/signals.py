"""Excitation signals of the paper, Section 4, and their kin.

A signal is defined in config.yaml by one kind and its parameters, for example
``sine: {frequency_hz: 40}``. A new kind is one function here, registered in
:data:`KINDS`; its keyword parameters are the keys that the config takes.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.errors import InputError, nearest
from hystbench.files import atomic_path
from hystbench.record import FloatArray
from hystbench.units import plain


@dataclass(frozen=True)
class Signal:
    """An input sampled uniformly.

    Parameters
    ----------
    name : str
        Name in config.yaml and in every result.
    dt : float
        Sampling interval in seconds.
    u : ndarray, shape (n,)
        Input in the unit of ``unit``.
    unit : str
        Unit of the input.
    """

    name: str
    dt: float
    u: FloatArray
    unit: str

    def __post_init__(self) -> None:
        """Keep a unit in its one spelling."""
        object.__setattr__(self, "unit", plain(self.unit))

    def save(self, path: str | Path) -> None:
        """Write the signal as a NumPy archive, all of it or nothing."""
        with atomic_path(path) as temporary, temporary.open("wb") as stream:
            np.savez(stream, u=self.u, name=self.name, dt=self.dt, unit=self.unit)


def load_signal(path: str | Path) -> Signal:
    """Read a signal that :meth:`Signal.save` wrote."""
    with np.load(path, allow_pickle=False) as archive:
        return Signal(
            name=str(archive["name"]),
            dt=float(archive["dt"]),
            u=archive["u"],
            unit=str(archive["unit"]),
        )


def _times(duration_s: float, sampling_frequency_hz: float) -> FloatArray:
    count = round(duration_s * sampling_frequency_hz)
    return np.asarray(np.arange(count) / sampling_frequency_hz)


def sine(
    *,
    frequency_hz: float,
    amplitude: float,
    duration_s: float,
    sampling_frequency_hz: float,
) -> FloatArray:
    """Compute ``amplitude * sin(2 pi f t)`` (Table 1, Figures 7 and 8).

    Returns
    -------
    ndarray, shape (round(duration_s * sampling_frequency_hz),)
        In the unit of ``amplitude``.
    """
    time = _times(duration_s, sampling_frequency_hz)
    return np.asarray(amplitude * np.sin(2 * np.pi * frequency_hz * time))


def chirp(
    *,
    from_hz: float,
    to_hz: float,
    amplitude: float,
    duration_s: float,
    sampling_frequency_hz: float,
) -> FloatArray:
    """Sweep the frequency linearly over the record (Table 2, Figure 9).

    ``amplitude * sin(2 pi (from t + (to - from) t^2 / (2 duration)))``.

    Returns
    -------
    ndarray, shape (round(duration_s * sampling_frequency_hz),)
        In the unit of ``amplitude``.
    """
    time = _times(duration_s, sampling_frequency_hz)
    slope = (to_hz - from_hz) / duration_s
    return np.asarray(
        amplitude * np.sin(2 * np.pi * (from_hz * time + slope * time**2 / 2))
    )


def sum_of_sines(
    *,
    frequencies_hz: Sequence[float],
    amplitudes: Sequence[float],
    gain: float,
    duration_s: float,
    sampling_frequency_hz: float,
) -> FloatArray:
    """Add sines that start at zero phase (Table 3, Figures 10 and 11).

    Parameters
    ----------
    frequencies_hz, amplitudes : sequence of float
        One of each a sine.
    gain : float
        Turns the unit in which the sum is written into the actuator's input unit:
        1 if the paper's sums are in amperes, the amplifier's gain if in volts.

    Raises
    ------
    InputError
        If there are not as many amplitudes as frequencies.
    """
    if len(frequencies_hz) != len(amplitudes):
        raise InputError(
            f"{len(frequencies_hz)} frequencies_hz but "
            f"{len(amplitudes)} amplitudes; expected as many"
        )
    time = _times(duration_s, sampling_frequency_hz)
    total = np.zeros_like(time)
    for frequency, amplitude in zip(frequencies_hz, amplitudes, strict=True):
        total += amplitude * np.sin(2 * np.pi * frequency * time)
    return np.asarray(gain * total)


def random_sum_of_sines(
    *,
    band: Sequence[float],
    level: float,
    sines: int,
    trials: int,
    seed: int,
    gain: float,
    duration_s: float,
    sampling_frequency_hz: float,
) -> FloatArray:
    """Add sines of random phase in a band (Table 3, Figure 12).

    The paper names MATLAB's ``idinput``, whose sums of sinusoids take lines of the
    record's own frequency grid, spread evenly over the band, with random phases: of
    ``trials`` draws the one with the smallest peak-to-peak is kept and scaled so that
    it spans ``[-level, level]``.

    Parameters
    ----------
    band : sequence of two float
        Lower and upper end as fractions of the Nyquist frequency.
    level : float
        The largest absolute value before ``gain``.
    sines, trials, seed : int
        How many lines, how many draws of the phases, and where the draws start.
    gain : float
        As in :func:`sum_of_sines`.

    Raises
    ------
    InputError
        If the band holds fewer lines than ``sines``.

    References
    ----------
    L. Ljung, System Identification Toolbox, function ``idinput``.
    """
    time = _times(duration_s, sampling_frequency_hz)
    count = len(time)
    if len(band) != 2 or not 0 <= band[0] < band[1] <= 1:
        raise InputError(
            f"band: {band}; expected two fractions of the Nyquist frequency"
        )
    low, high = (edge * count / 2 for edge in band)
    lines = np.arange(max(1, int(np.ceil(low))), int(np.floor(high)) + 1)
    if len(lines) < sines:
        raise InputError(
            f"the band {list(band)} holds {len(lines)} lines in "
            f"{duration_s:g} s; expected at least {sines} (key 'sines')"
        )
    # Evenly spaced, counted from the band's upper end so that its edge is excited.
    chosen = lines[len(lines) - 1 - (len(lines) // sines) * np.arange(sines)][::-1]
    generator = np.random.default_rng(seed)
    phases = generator.uniform(0, 2 * np.pi, (trials, sines))
    # Lines of the record's own grid: a transform adds them up, all draws at once.
    spectrum = np.zeros((trials, count // 2 + 1), complex)
    spectrum[:, chosen] = count / 2 * np.exp(1j * phases)
    spectrum[:, chosen[2 * chosen == count]] *= 2  # has no mirror image
    draws = np.fft.irfft(spectrum, count)
    best = draws[np.argmin(np.ptp(draws, axis=1))]
    middle = (best.max() + best.min()) / 2
    return np.asarray(gain * level * (best - middle) / (np.ptp(best) / 2))


KINDS: dict[str, Callable[..., FloatArray]] = {
    "sine": sine,
    "chirp": chirp,
    "sum-of-sines": sum_of_sines,
    "random-sum-of-sines": random_sum_of_sines,
}


def check_definition(
    name: str,
    definition: Mapping[str, Mapping[str, Any]],
    common: Mapping[str, Any],
    place: str = "config.yaml",
) -> tuple[str, dict[str, Any]]:
    """Check a signal's definition in config.yaml without making the signal.

    Parameters
    ----------
    name : str
        The signal's name.
    definition : mapping
        One key, the kind, and its parameters; they win over ``common``.
    common : mapping
        Values for the parameters that the definition leaves out.
    place : str
        Name of the file, for messages.

    Returns
    -------
    kind : str
    values : dict
        A value for each parameter of the kind.

    Raises
    ------
    InputError
        If the kind or a parameter is unknown, or one is missing.
    """
    place = f"{place}: excitations: {name}"
    ((kind, given),) = definition.items()
    if kind not in KINDS:
        raise InputError(f"{place}: unknown kind {kind!r}; {nearest(kind, KINDS)}")
    parameters = inspect.signature(KINDS[kind]).parameters
    expected = list(parameters)
    for key in given:
        if key not in expected:
            raise InputError(f"{place}: unknown key {key!r}; {nearest(key, expected)}")
    values = {key: common[key] for key in expected if key in common} | dict(given)
    for key in expected:
        if key not in values:
            raise InputError(f"{place}: {kind} misses the key {key!r}")
        _check_value(f"{place}: {key}", key, values[key], parameters[key].annotation)
    return kind, values


def highest_hz(
    name: str, definition: Mapping[str, Mapping[str, Any]], common: Mapping[str, Any]
) -> float:
    """Give the highest frequency in a signal's definition in config.yaml.

    Parameters
    ----------
    name, definition, common
        As for :func:`check_definition`.
    """
    _, values = check_definition(name, definition, common)
    if "band" in values:
        return float(values["band"][1] * values["sampling_frequency_hz"] / 2)
    if "frequencies_hz" in values:
        return float(max(values["frequencies_hz"]))
    if "to_hz" in values:
        return float(max(values["from_hz"], values["to_hz"]))
    return float(values["frequency_hz"])


def _check_value(place: str, key: str, value: object, annotation: str) -> None:
    """Refuse what is not of the parameter's type, or no frequency or count."""
    numbers = value if annotation == "Sequence[float]" else [value]
    types = (int,) if annotation == "int" else (int, float)
    if not isinstance(numbers, list) or not all(
        type(number) in types and np.isfinite(number) for number in numbers
    ):
        expected = {"int": "a whole number", "float": "a finite number"}
        told = expected.get(annotation, "a list of finite numbers")
        raise InputError(f"{place}: {value!r}; expected {told}")
    least = (
        0 if key in _MAY_BE_ZERO else 1 if annotation == "int" else np.nextafter(0, 1)
    )
    if key not in _ANY_SIGN and any(number < least for number in numbers):
        more = "0 or more" if least == 0 else "1 or more" if least == 1 else "above 0"
        raise InputError(f"{place}: {value!r}; expected {more}")


_MAY_BE_ZERO = {"seed", "band"}
_ANY_SIGN = {"amplitude", "amplitudes", "gain"}


def make_signal(
    name: str,
    definition: Mapping[str, Mapping[str, Any]],
    common: Mapping[str, Any],
    place: str = "config.yaml",
) -> Signal:
    """Make a signal from its definition in config.yaml.

    Takes what :func:`check_definition` takes; ``common`` has the ``unit`` as well.

    Raises
    ------
    InputError
        As there, or if a frequency is not below half the sampling frequency or the
        signal does not move.
    """
    kind, values = check_definition(name, definition, common, place)
    where = f"{place}: excitations: {name}"
    nyquist = values["sampling_frequency_hz"] / 2
    for key, value in values.items():
        if key.endswith("_hz") and key != "sampling_frequency_hz":
            highest = max(value) if isinstance(value, list) else value
            if highest >= nyquist:
                raise InputError(
                    f"{where}: {key}: {highest:g}; expected below {nyquist:g} Hz, "
                    "half the sampling frequency"
                )
    try:
        u = KINDS[kind](**values)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None
    if len(u) < 2 or np.ptp(u) == 0:
        raise InputError(
            f"{where}: {len(u)} samples that do not move; expected a signal"
        )
    return Signal(name, 1 / values["sampling_frequency_hz"], u, common["unit"])
