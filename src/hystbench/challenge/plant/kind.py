"""What an effect is: its place, its forms and the ranges its parameters come from.

Of an actuator and of a machine alike; what a form does there is another function. The
effects are tables in YAML beside this module.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any, Literal

import numpy as np

from hystbench.record import FloatArray
from hystbench.yaml_files import load_yaml

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

#: Steps in which the size of an effect is changed, at most.
RESIZINGS = 6


@dataclass(frozen=True)
class PlantRun:
    """What an effect may see of one record beside its own input."""

    time: FloatArray
    u: FloatArray
    """Shape (n,). The fine grid in seconds and the command on it in amperes."""
    dt: float
    """Step of the fine grid in seconds."""
    random: np.random.Generator
    """Source of what is new in every record: a phase, a path."""


NO_RUN = PlantRun(np.zeros(0), np.zeros(0), 1.0, np.random.default_rng(0))


def log_uniform(random: np.random.Generator, low: float, high: float) -> float:
    """Draw a number between two, evenly in its logarithm."""
    return float(np.exp(random.uniform(np.log(low), np.log(high))))


@dataclass(frozen=True)
class Range:
    """Interval that a parameter is drawn from, evenly in its logarithm."""

    low: float
    high: float
    """The interval."""
    unit: str
    sign: bool = False
    """Whether a coin gives the sign."""
    shifts: bool = True
    """Whether ``spread`` multiplies the interval."""
    least: float = 0.0
    most: float = np.inf
    """What physics and the numerics allow, whatever the spread."""

    def draw(self, random: np.random.Generator, spread: float = 1.0) -> float:
        """Draw a value."""
        scale = spread if self.shifts else 1.0
        value = scale * log_uniform(random, self.low, self.high)
        # drawn in any case, so that a sign more does not change what follows
        coin = 1.0 if random.uniform() < 0.5 else -1.0
        value = float(np.clip(value, self.least, self.most))
        return value * coin if self.sign else value

    def clip(self, value: float) -> float:
        """Keep a value where physics and the numerics allow."""
        return float(np.copysign(np.clip(abs(value), self.least, self.most), value))


@dataclass(frozen=True)
class Reach:
    """The largest values of the linear machine on its fit records."""

    position: float
    velocity: float
    force: float
    output: float
    """Largest output. In a tank ``position`` is the level of each, so far as they are
    alike, ``force`` the inflow and ``velocity`` that level over the time in which it
    settles."""
    stiffness: float
    """Stiffness of the linear spring; where there is none, force over position."""


Act = Callable[[FloatArray, PlantRun, Parameters], FloatArray]
Numbers = dict[str, float]
Inside = Callable[[Parameters, Reach], Numbers]
Curve = Callable[[FloatArray, Parameters, Reach], FloatArray]


@dataclass(frozen=True)
class Form:
    """One way in which an effect may be written."""

    act: Act | None = None
    """Function of an effect in an actuator: it takes the signal, the run and the
    parameters and gives the signal. None where the hysteresis itself is another, and in
    a machine."""
    ranges: Mapping[str, Range] = field(default_factory=dict)
    """Range of each parameter."""
    size: str = ""
    """The parameter that makes the effect larger (``power`` above zero: the difference
    grows roughly with this power) or smaller (below zero); empty where there is
    none."""
    power: float = 1.0
    stage: Stage | None = None
    """Stage at which this form acts, if it is another than its kind's."""
    told: Callable[[Parameters], dict[str, Any]] = dict
    """Gives the parameters under the vocabulary's names."""
    numbers: Inside | None = None
    """Inside a machine: gives the numbers of its part or of each tank."""
    curve: Curve | None = None
    """Function of an effect before or behind a machine: it gives the signal."""


@dataclass(frozen=True)
class EffectKind:
    """A physical effect: where it acts, where it shows, how it may be written."""

    name: str
    place: str
    """Place of the effect: in an actuator ``drive``, ``material``, ``mechanics`` or
    ``sensor``; in a machine ``before``, ``inside`` or ``behind``."""
    stage: Stage = "mechanics"
    """Stage of an actuator's chain at which it acts."""
    views: tuple[str, ...] = ()
    """Views of gap.json in which it shows in an actuator."""
    forms: Mapping[str, Form] = field(default_factory=dict)
    listed: bool = True
    """Whether the vocabulary has a word for it."""
    families: tuple[str, ...] = ()
    """Machines that it may be in."""


@dataclass(frozen=True)
class HiddenEffect:
    """An effect with its form and parameters drawn."""

    kind: EffectKind
    form: str
    parameters: Parameters

    @property
    def of_form(self) -> Form:
        """Its form, which tells what it does."""
        return self.kind.forms[self.form]

    @property
    def stage(self) -> Stage:
        """Where in the chain of an actuator it acts."""
        return self.of_form.stage or self.kind.stage

    def act(self, signal: FloatArray, run: PlantRun) -> FloatArray:
        """Compute what the effect makes of a signal."""
        act = self.of_form.act
        return act(signal, run, self.parameters) if act else signal

    def scaled(self, factor: float) -> HiddenEffect:
        """Make its difference about so many times as large, as far as it may be."""
        form = self.of_form
        if not form.size:
            return self
        wanted = self.parameters[form.size] * factor ** (1.0 / form.power)
        value = form.ranges[form.size].clip(wanted)
        return replace(self, parameters={**self.parameters, form.size: value})

    def resized(
        self,
        share: Callable[[HiddenEffect], float],
        within: tuple[float, float],
        margin: float,
        most: float,
    ) -> HiddenEffect:
        """Change its size until it neither drowns nor drowns the rest.

        Parameters
        ----------
        share : callable
            Gives how large an effect is, as a share of the output.
        within : (float, float)
            Least and largest share; what is outside is aimed inside by ``margin``.
        margin : float
        most : float
            Factor on its size in one step, where it shows nothing at all.
        """
        effect = self
        for _ in range(RESIZINGS):
            now = share(effect)
            if within[0] <= now <= within[1]:
                break
            ends = (1.0 + margin) * within[0], (1.0 - margin) * within[1]
            wanted = float(np.clip(now, *ends))
            factor = float(np.clip(wanted / max(now, 1e-12), 1.0 / most, most))
            other = effect.scaled(factor)
            if dict(other.parameters) == dict(effect.parameters):
                break
            effect = other
        return effect


def draw(
    kind: EffectKind,
    random: np.random.Generator,
    spread: float,
    allowed: tuple[str, ...] = (),
) -> HiddenEffect:
    """Draw an effect's form, of those allowed or of all, and its parameters."""
    allowed = allowed or tuple(kind.forms)
    form = allowed[int(random.integers(len(allowed)))]
    ranges = kind.forms[form].ranges
    values = {name: item.draw(random, spread) for name, item in ranges.items()}
    return HiddenEffect(kind, form, values)


def read_kinds(
    table: str, *modules: ModuleType
) -> tuple[dict[str, EffectKind], list[set[str]]]:
    """Read effects from a table beside this module, by name and in its order.

    Beside them stand pairs of effects that are never hidden together.

    A form names the functions of these modules that it calls (``act``, ``curve``,
    ``told``); ``also`` are words that are told beside its parameters, and ``numbers``
    products such as ``share * machine.stiffness / machine.position^2``, whose factors
    are its parameters and those of :class:`Reach`. A ``curve`` that is an actuator's
    too stands with such products for the parameters that it has there.
    """
    kinds = load_yaml(Path(__file__).with_name(table))
    apart = [set(pair) for pair in kinds.pop("apart")]
    known = {
        f"{module.__name__.rpartition('.')[2]}.{key}": item
        for module in modules
        for key, item in vars(module).items()
    }
    return {name: _kind(known, name, **about) for name, about in kinds.items()}, apart


def _kind(
    known: Mapping[str, Any], name: str, forms: Mapping[str, Any], **about: Any
) -> EffectKind:
    lists = {key: tuple(about.pop(key, ())) for key in ("views", "families")}
    about |= lists | {
        "forms": {form: _form(known, **said) for form, said in forms.items()}
    }
    return EffectKind(name, **about)


def _form(
    known: Mapping[str, Any],
    ranges: Mapping[str, Any] = {},
    numbers: Mapping[str, str] | None = None,
    also: Mapping[str, str] | None = None,
    **about: Any,
) -> Form:
    for key in ("act", "curve", "told"):
        if isinstance(about.get(key), dict):
            ((name, products),) = about[key].items()
            about[key] = partial(_as_in_actuator, known[name], products)
        elif key in about:
            about[key] = known[about[key]]
    if numbers:
        about["numbers"] = partial(_numbers, numbers)
    if also:
        about["told"] = partial(_with, also)
    return Form(ranges={name: Range(**item) for name, item in ranges.items()}, **about)


def _as_in_actuator(
    act: Act,
    products: Mapping[str, str],
    signal: FloatArray,
    p: Parameters,
    reach: Reach,
) -> FloatArray:
    """Bend a signal of a machine as in an actuator, where no run is looked at."""
    return act(signal, NO_RUN, _numbers(products, p, reach))


def _with(words: Mapping[str, str], parameters: Parameters) -> dict[str, Any]:
    return {**parameters, **words}


def _numbers(products: Mapping[str, str], p: Parameters, reach: Reach) -> Numbers:
    """Compute products of parameters and of a machine's reach, from left to right."""
    known = {**p, **{f"machine.{key}": value for key, value in vars(reach).items()}}
    found = {}
    for name, product in products.items():
        found[name] = 1.0
        for sign, word, power in re.findall(r"([*/]?) ?([\w.]+)(?:\^(\d))?", product):
            factor = (known[word] if word in known else float(word)) ** int(power or 1)
            found[name] *= factor if sign != "/" else 1.0
            found[name] /= factor if sign == "/" else 1.0
    return found
