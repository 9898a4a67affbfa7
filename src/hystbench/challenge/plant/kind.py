"""What an effect is: its place, its forms and the ranges its parameters come from."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from hystbench.record import FloatArray

View = Literal[
    "frequency",
    "amplitude",
    "rate",
    "branch",
    "slow-time",
    "delay",
    "unexplained",
    "record",
]

#: Where in the chain an effect acts, in the order of the signal's way.
Stage = Literal[
    "command",  # on time: when the drive sees the command
    "drive",
    "field",  # before the hysteresis
    "threshold",  # on the thresholds of the plays
    "material",
    "mode",  # in the place of the linear mode
    "mechanics",
    "sensor",
    "sampling",  # on time: when a sample is taken
    "samples",  # on the samples taken
]

Parameters = Mapping[str, float]


@dataclass(frozen=True)
class Run:
    """What an effect may see of one record beside its own input.

    Parameters
    ----------
    time, u : ndarray, shape (n,)
        The fine grid in seconds and the command on it in amperes.
    dt : float
        Step of the fine grid in seconds.
    random : numpy.random.Generator
        Source of what is new in every record: a phase, a path.
    """

    time: FloatArray
    u: FloatArray
    dt: float
    random: np.random.Generator


@dataclass(frozen=True)
class Range:
    """Interval that a parameter is drawn from, evenly in its logarithm.

    Parameters
    ----------
    low, high : float
        The interval.
    unit : str
    sign : bool
        Whether a coin gives the sign.
    shifts : bool
        Whether ``spread`` multiplies the interval.
    least, most : float, optional
        What physics and the numerics allow, whatever the spread.
    """

    low: float
    high: float
    unit: str
    sign: bool = False
    shifts: bool = True
    least: float = 0.0
    most: float = np.inf

    def draw(self, random: np.random.Generator, spread: float = 1.0) -> float:
        """Draw a value."""
        scale = spread if self.shifts else 1.0
        value = scale * np.exp(random.uniform(np.log(self.low), np.log(self.high)))
        # drawn in any case, so that a sign more does not change what follows
        coin = 1.0 if random.uniform() < 0.5 else -1.0
        value = float(np.clip(value, self.least, self.most))
        return value * coin if self.sign else value

    def clip(self, value: float) -> float:
        """Keep a value where physics and the numerics allow."""
        return float(np.copysign(np.clip(abs(value), self.least, self.most), value))


Act = Callable[[FloatArray, Run, Parameters], FloatArray]


def _same(parameters: Parameters) -> dict[str, Any]:
    return dict(parameters)


@dataclass(frozen=True)
class Form:
    """One way in which an effect may be written.

    Parameters
    ----------
    act : callable
        Takes the signal, the run and the parameters and gives the signal.
    ranges : mapping of str to Range
        By parameter.
    size : str
        The parameter that makes the effect larger (``power`` above zero: the
        difference grows roughly with this power) or smaller (below zero); empty where
        there is none.
    power : float
    stage : str, optional
        Where this form acts, if not where its kind does.
    told : callable
        Gives the parameters under the vocabulary's names.
    """

    act: Act
    ranges: Mapping[str, Range] = field(default_factory=dict)
    size: str = ""
    power: float = 1.0
    stage: Stage | None = None
    told: Callable[[Parameters], dict[str, Any]] = _same


@dataclass(frozen=True)
class Kind:
    """A physical effect: where it acts, where it shows, how it may be written."""

    name: str
    place: str
    stage: Stage
    views: tuple[View, ...]
    forms: Mapping[str, Form]
    use: Literal["vocabulary", "development", "transfer"] = "vocabulary"


@dataclass(frozen=True)
class Effect:
    """An effect with its form and parameters drawn."""

    kind: Kind
    form: str
    parameters: Parameters

    @property
    def stage(self) -> Stage:
        """Where in the chain it acts."""
        return self.kind.forms[self.form].stage or self.kind.stage

    def act(self, signal: FloatArray, run: Run) -> FloatArray:
        """Compute what the effect makes of a signal."""
        return self.kind.forms[self.form].act(signal, run, self.parameters)

    def scaled(self, factor: float) -> Effect:
        """Make its difference about so many times as large, as far as it may be."""
        form = self.kind.forms[self.form]
        if not form.size:
            return self
        wanted = self.parameters[form.size] * factor ** (1.0 / form.power)
        value = form.ranges[form.size].clip(wanted)
        return Effect(self.kind, self.form, {**self.parameters, form.size: value})


def draw(
    kind: Kind, random: np.random.Generator, spread: float, allowed: tuple[str, ...]
) -> Effect:
    """Draw an effect's form, of those allowed, and its parameters."""
    form = allowed[int(random.integers(len(allowed)))]
    ranges = kind.forms[form].ranges
    values = {name: item.draw(random, spread) for name, item in ranges.items()}
    return Effect(kind, form, values)
