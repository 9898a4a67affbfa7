"""How far rival models lie apart on an input, beyond what a refit takes away."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple, Protocol

import numpy as np

from hystbench.errors import InputError
from hystbench.gap.records.residual import rms
from hystbench.model import Model
from hystbench.record import FloatArray


class Simulator(Protocol):
    """What runs from an input: a model."""

    def simulate(self, u: FloatArray, dt: float) -> FloatArray:
        """Compute the output from rest."""
        ...


#: Directions in which a refit may move an output: shape (n, m) from u, dt and output.
Tangents = Callable[[FloatArray, float, FloatArray], FloatArray]


@dataclass(frozen=True, eq=False)
class Rival:
    """A model that others are to be told from.

    Parameters
    ----------
    model : Simulator
    tangents : callable, optional
        What a refit of it may change besides gain and offset.
    """

    model: Simulator
    tangents: Tangents | None = None


#: Rivals by name, of each effect in whose place they are. A name may be in two sets.
Sets = Mapping[str, Mapping[str, Rival]]


class Pair(NamedTuple):
    """Two rivals of one set."""

    of: str
    """The effect whose set it is."""
    names: tuple[str, str]


def pairs_of(sets: Sets) -> tuple[Pair, ...]:
    """Give all pairs within a set; what is in two sets needs no telling apart."""
    return tuple(
        Pair(of, names)
        for of, members in sets.items()
        for names in combinations(members, 2)
    )


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


def separations(
    sets: Sets, u: FloatArray, dt: float, noise_floor: float
) -> dict[Pair, float]:
    """Give the separation of each pair within a set, every rival simulated once.

    A pair may be refitted along the tangents of both its models, and of no other.

    Parameters
    ----------
    sets : mapping of str to mapping of str to Rival
        A rival may stand in several of them.
    u : ndarray, shape (n,)
    dt : float
        Sampling interval in seconds.
    noise_floor : float
        RMS, in the outputs' unit.

    Returns
    -------
    dict of Pair to float
        In noise floors, without those of which one does not run to the end.
    """
    rivals = {id(x): x for members in sets.values() for x in members.values()}
    ran = {key: _run(rival, u, dt) for key, rival in rivals.items()}
    found = {}
    for pair in pairs_of(sets):
        first, second = (ran[id(sets[pair.of][name])] for name in pair.names)
        if first is not None and second is not None:
            free = np.hstack([first.tangents, second.tangents])
            found[pair] = separation(first.output, second.output, noise_floor, free)
    return found


class _Ran(NamedTuple):
    output: FloatArray
    tangents: FloatArray


def _run(rival: Rival, u: FloatArray, dt: float) -> _Ran | None:
    """Simulate a rival and its tangents; None where they do not run to the end.

    As where a simulator of somebody's own refuses an input.
    """
    tangents = np.zeros((len(u), 0))
    try:
        with np.errstate(over="ignore", invalid="ignore"):
            output = rival.model.simulate(u, dt)
            if rival.tangents is not None and np.isfinite(output).all():
                tangents = rival.tangents(u, dt, output)
    except InputError:
        return None
    whole = np.isfinite(output).all() and np.isfinite(tangents).all()
    return _Ran(output, tangents) if whole else None


CHANGE = 1e-3
"""Relative change by which a direction is taken; of 0 an absolute one."""


def parameter_tangents(model: Model, names: Sequence[str]) -> Tangents:
    """Directions in which a refit of named parameters moves a model's output.

    Without them a single sine seems to tell a lag from a delay that another time
    constant would imitate.

    Parameters
    ----------
    model : Model
    names : sequence of str
        Its parameters that a refit may change; numbers, or lists of them that are
        changed together, by a common factor.
    """

    def beside(name: str) -> Iterator[Model]:
        value = model.value(name)
        new: float | list[float]
        if isinstance(value, str):
            raise InputError(f"{name}: {value!r} is no number; expected one to refit")
        if isinstance(value, tuple):
            new = [item * (1 + CHANGE) for item in value]
        else:
            new = value * (1 + CHANGE) if value else CHANGE
        # A zero that stands for "none" has no neighbour: the block refuses it.
        with contextlib.suppress(InputError):
            yield model.with_values({name: new})

    moved = [other for name in names for other in beside(name)]

    def tangents(u: FloatArray, dt: float, output: FloatArray) -> FloatArray:
        columns = [other.simulate(u, dt) - output for other in moved]
        return np.column_stack(columns) if columns else np.zeros((len(u), 0))

    return tangents
