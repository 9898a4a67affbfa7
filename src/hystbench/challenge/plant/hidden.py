"""What an effect of a machine is: its place, its laws, and its size."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from hystbench.challenge.plant.kind import Parameters, Range
from hystbench.record import FloatArray

Numbers = dict[str, float]


@dataclass(frozen=True)
class Reach:
    """The largest values of the linear machine on its fit records.

    Parameters
    ----------
    position, velocity, force, output : float
        Of a tank ``position`` is the level of each, so far as they are alike.
    stiffness : float
        That of the linear spring; where there is none, force over position.
    """

    position: float
    velocity: float
    force: float
    output: float
    stiffness: float


Inside = Callable[[Parameters, Reach], Numbers]
Curve = Callable[[FloatArray, Parameters, Reach], FloatArray]


@dataclass(frozen=True)
class Law:
    """One form of an effect.

    Parameters
    ----------
    ranges : mapping of str to Range
    size : str
        The parameter that the effect grows with; falls with, if ``power`` is below 0.
    numbers : callable, optional
        Gives the numbers of a part or of each tank, of an effect inside.
    curve : callable, optional
        Of an effect before or behind: gives the signal.
    power : float
    """

    ranges: Mapping[str, Range]
    size: str
    numbers: Inside | None = None
    curve: Curve | None = None
    power: float = 1.0


@dataclass(frozen=True)
class Hideable:
    """An effect of machines.

    Parameters
    ----------
    name : str
    place : {"before", "inside", "behind"}
    families : tuple of str
    laws : mapping of str to Law
    """

    name: str
    place: Literal["before", "inside", "behind"]
    families: tuple[str, ...]
    laws: Mapping[str, Law]


@dataclass(frozen=True)
class Hidden:
    """An effect with its form and parameters drawn."""

    kind: Hideable
    form: str
    parameters: Parameters = field(default_factory=dict)

    @property
    def law(self) -> Law:
        """Its form."""
        return self.kind.laws[self.form]

    def scaled(self, factor: float) -> Hidden:
        """Make it about so many times as large, as far as it may be."""
        law = self.law
        wanted = self.parameters[law.size] * factor ** (1.0 / law.power)
        value = law.ranges[law.size].clip(wanted)
        return Hidden(self.kind, self.form, {**self.parameters, law.size: value})


def draw(kind: Hideable, random: np.random.Generator, spread: float) -> Hidden:
    """Draw an effect's form and parameters."""
    forms = tuple(kind.laws)
    form = forms[int(random.integers(len(forms)))]
    ranges = kind.laws[form].ranges
    values = {name: item.draw(random, spread) for name, item in ranges.items()}
    return Hidden(kind, form, values)
