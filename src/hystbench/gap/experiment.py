"""The next experiment: which excitation tells rival models apart, and by how much."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any, Protocol

import numpy as np

from hystbench.errors import InputError
from hystbench.gap.compared import rms
from hystbench.gap.excitations import Excitation, candidates
from hystbench.gap.limits import Limits
from hystbench.model import Model
from hystbench.record import FloatArray, Record

#: A pair that differs by so many floors is told apart: more of it helps no other pair.
CLEAR = 3.0


class Simulator(Protocol):
    """What runs from an input: a model."""

    def simulate(self, u: FloatArray, dt: float) -> FloatArray:
        """Compute the output from rest."""
        ...


#: Directions in which a refit may move the output: shape (n, m) from u and dt.
Tangents = Callable[[FloatArray, float], FloatArray]


@dataclass(frozen=True, repr=False)
class Experiment:
    """The excitation that separates rivals best.

    Parameters
    ----------
    excitation : Excitation
    pairs : dict of (str, str) to float
        Separation of each pair of rivals, in noise floors.
    existing : dict of (str, str) to float
        The same for the existing record that is best for the pair.
    """

    excitation: Excitation
    pairs: dict[tuple[str, str], float]
    existing: dict[tuple[str, str], float]

    @property
    def separation(self) -> float:
        """Separation of the pair that is hardest to tell apart, in noise floors."""
        return min(self.pairs.values())

    @property
    def existing_separation(self) -> float:
        """What the existing records reach for the pair that is hardest for them."""
        return min(self.existing.values())

    @property
    def sentence(self) -> str:
        """What to do and what it gives, in words."""
        hardest = min(self.pairs, key=lambda pair: self.pairs[pair])
        names = " from ".join(hardest)
        size, now = self.pairs[hardest], self.existing[hardest]
        best = self.excitation.words
        if size < 1:
            return (
                f"No feasible excitation tells {names}: the best, {best}, separates "
                f"them by {size:.2g} noise floors after gain and offset are refitted."
            )
        if size <= now:
            return (
                f"The existing records tell {names} by {now:.2g} noise floors after "
                f"gain and offset are refitted; the best feasible excitation, {best}, "
                f"reaches {size:.2g}."
            )
        return (
            f"Try {best}: it separates {names} by {size:.2g} noise floors after gain "
            f"and offset are refitted; the best of the existing records reaches "
            f"{now:.2g}."
        )

    def mapping(self) -> dict[str, Any]:
        """Give what gap.json holds under ``next_experiment``."""
        return {
            "excitation": self.excitation.kind,
            "parameters": {
                name: {"value": value, "unit": unit}
                for name, (value, unit) in self.excitation.parameters.items()
            },
            "sampling_interval_s": self.excitation.dt,
            "separation": self.separation,
            "existing_separation": self.existing_separation,
            "pairs": [
                {
                    "names": list(pair),
                    "separation": size,
                    "existing_separation": self.existing[pair],
                }
                for pair, size in self.pairs.items()
            ],
            "sentence": self.sentence,
        }


def separation(
    first: FloatArray,
    second: FloatArray,
    noise_floor: float,
    tangents: FloatArray | None = None,
) -> float:
    """RMS difference of two outputs that no refit takes away, in noise floors.

    The part of ``first - second`` orthogonal to an offset, to a gain (the mean of the
    two outputs) and to the tangents that are given.

    Parameters
    ----------
    first, second : ndarray, shape (n,)
    noise_floor : float
        RMS, in the outputs' unit.
    tangents : ndarray, shape (n, m), optional

    Returns
    -------
    float
    """
    columns = [np.ones_like(first), (first + second) / 2]
    if tangents is not None:
        columns += list(tangents.T)
    basis = np.column_stack(columns)
    size = np.sqrt(np.mean(np.square(basis), axis=0))
    basis = basis / np.where(size > 0, size, 1.0)
    difference = first - second
    weights, *_ = np.linalg.lstsq(basis, difference, rcond=1e-9)
    return rms(difference - basis @ weights) / noise_floor


def parameter_tangents(
    rivals: Sequence[tuple[Model, Sequence[str]]], step: float = 1e-3
) -> Tangents:
    """Directions in which a refit of named parameters moves the rivals' outputs.

    Without them a single sine seems to tell a lag from a delay that another time
    constant would imitate.

    Parameters
    ----------
    rivals : sequence of (Model, sequence of str)
        A model and the names of its parameters that a refit may change; numbers, or
        lists of them that are changed together, by a common factor.
    step : float
        Relative change; of 0 an absolute one.
    """

    def beside(model: Model, name: str) -> Iterator[Model]:
        value = model.value(name)
        new: float | list[float]
        if isinstance(value, str):
            raise InputError(f"{name}: {value!r} is no number; expected one to refit")
        if isinstance(value, tuple):
            new = [item * (1 + step) for item in value]
        else:
            new = value * (1 + step) if value else step
        # A zero that stands for "none" has no neighbour: the block refuses it.
        with contextlib.suppress(InputError):
            yield model.with_values({name: new})

    moved = [
        (model, [other for name in names for other in beside(model, name)])
        for model, names in rivals
    ]

    def tangents(u: FloatArray, dt: float) -> FloatArray:
        columns = []
        for model, others in moved:
            now = model.simulate(u, dt)
            columns += [other.simulate(u, dt) - now for other in others]
        return np.column_stack(columns) if columns else np.zeros((len(u), 0))

    return tangents


def next_experiment(
    rivals: Sequence[tuple[str, Simulator]],
    records: Sequence[Record],
    noise_floor: float,
    limits: Limits | None = None,
    tangents: Tangents | None = None,
    excitations: Sequence[Excitation] | None = None,
) -> Experiment:
    """Choose the excitation that tells rival models apart best.

    Parameters
    ----------
    rivals : sequence of (str, model)
        At least two, each fitted to the records.
    records : sequence of Record
        The fit records: what they separate is the measure, and their inputs are the
        limits where none are given.
    noise_floor : float
        RMS in output units, above zero.
    limits : Limits, optional
    tangents : callable, optional
        What a refit may change besides gain and offset.
    excitations : sequence of Excitation, optional
        Instead of :func:`~hystbench.gap.excitations.candidates`.

    Returns
    -------
    Experiment
        Of the excitations with the most pairs told apart, the one that separates the
        hardest pair most.

    Raises
    ------
    InputError
        If there are fewer than two rivals, no noise floor, or no excitation keeps
        within the limits and lets every rival run.
    """
    if len(rivals) < 2:
        raise InputError(f"{len(rivals)} rival models; expected at least two")
    if not noise_floor > 0:
        raise InputError(f"noise floor: {noise_floor:g}; expected above 0")
    if excitations is None:
        limits = Limits.of(records) if limits is None else limits
        excitations = candidates(limits, records[0].input.unit)
    tried = [
        (item, _pairs(rivals, item.u, item.dt, noise_floor, tangents))
        for item in excitations
    ]
    run = [(item, pairs) for item, pairs in tried if pairs is not None]
    if not run:
        raise InputError(
            f"next experiment: none of {len(tried)} excitations keeps within the "
            "limits and gives finite outputs; expected wider limits"
        )
    excitation, pairs = max(run, key=lambda each: _merit(each[1]))
    existing = dict.fromkeys(pairs, 0.0)
    for record in records:
        reached = _pairs(rivals, record.u, record.dt, noise_floor, tangents)
        for pair, size in (reached or {}).items():
            existing[pair] = max(existing[pair], size)
    return Experiment(excitation, pairs, existing)


def _merit(pairs: dict[tuple[str, str], float]) -> tuple[float, float]:
    sizes = list(pairs.values())
    return sum(min(size, CLEAR) for size in sizes), min(sizes)


def _pairs(
    rivals: Sequence[tuple[str, Simulator]],
    u: FloatArray,
    dt: float,
    noise_floor: float,
    tangents: Tangents | None,
) -> dict[tuple[str, str], float] | None:
    """Separation of each pair; None where a model does not run to the end."""
    outputs = [(name, model.simulate(u, dt)) for name, model in rivals]
    if not all(np.isfinite(output).all() for _, output in outputs):
        return None
    free = None if tangents is None else tangents(u, dt)
    return {
        (one, other): separation(first, second, noise_floor, free)
        for (one, first), (other, second) in combinations(outputs, 2)
    }
