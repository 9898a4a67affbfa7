"""How far rival models lie apart on an input, beyond what a refit takes away."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np

from hystbench.errors import InputError
from hystbench.metrics import rms
from hystbench.model import Model
from hystbench.record import FloatArray

CHANGE = 1e-3
"""Relative change of a parameter in a refit; of 0 an absolute one."""


class RivalRun(NamedTuple):
    """Output of a rival, shape (n,), and the directions of a refit, shape (n, m)."""

    output: FloatArray
    tangents: FloatArray


@dataclass(frozen=True, eq=False)
class Rival:
    """A model that others are to be told from."""

    model: Model
    neighbours: tuple[Model, ...] = ()
    """What a refit of it may move towards, besides another gain and offset."""

    @classmethod
    def of(cls, model: Model, names: Sequence[str]) -> Rival:
        """Let a refit change parameters; lists of numbers by a common factor.

        Without them a single sine seems to tell a lag from a delay that another time
        constant would imitate.
        """
        found = []
        for name in names:
            value = model.value(name)
            new: float | list[float]
            if isinstance(value, str):
                raise InputError(
                    f"{name}: {value!r} is no number; expected one to refit"
                )
            if isinstance(value, tuple):
                new = [item * (1 + CHANGE) for item in value]
            else:
                new = value * (1 + CHANGE) if value else CHANGE
            # A zero that stands for "none" has no neighbour: the block refuses it.
            with suppress(InputError):
                found.append(model.with_values({name: new}))
        return cls(model, tuple(found))

    def run(self, u: FloatArray, dt: float) -> RivalRun | None:
        """Simulate it and its neighbours; None where they do not run to the end.

        As where a simulator of somebody's own refuses an input.
        """
        try:
            with np.errstate(over="ignore", invalid="ignore"):
                outputs = self.model.simulate_near(self.neighbours, u, dt)
        except InputError:
            return None
        every = np.column_stack(outputs)
        if not np.isfinite(every).all():
            return None
        return RivalRun(every[:, 0], every[:, 1:] - every[:, :1])


Sets = Mapping[str, Mapping[str, Rival]]
"""Rivals by name, of each effect in whose place they are. A name may be in two sets."""


class RivalPair(NamedTuple):
    """Two rivals of one set."""

    of: str
    """The effect whose set it is."""
    names: tuple[str, str]


def separation(first: RivalRun, second: RivalRun, noise_floor: float) -> float:
    """RMS difference of two outputs that no refit takes away, in noise floors.

    The part of ``first - second`` orthogonal to an offset, to a gain (the mean of the
    two outputs) and to the tangents of both.

    Parameters
    ----------
    first, second : RivalRun
    noise_floor : float
        RMS, in the outputs' unit.
    """
    a, b = first.output, second.output
    basis = np.column_stack(
        [np.ones_like(a), (a + b) / 2, first.tangents, second.tangents]
    )
    size = np.sqrt(np.mean(np.square(basis), axis=0))
    basis = basis / np.where(size > 0, size, 1.0)
    weights, *_ = np.linalg.lstsq(basis, a - b, rcond=1e-9)
    return rms(a - b - basis @ weights) / noise_floor


def separations(
    sets: Sets, u: FloatArray, dt: float, noise_floor: float
) -> dict[RivalPair, float]:
    """Give the separation of each pair within a set.

    What is in two sets needs no telling apart.

    Parameters
    ----------
    sets : mapping of str to mapping of str to Rival
    u : ndarray, shape (n,)
    dt : float
        Sampling interval in seconds.
    noise_floor : float
        RMS, in the outputs' unit.

    Returns
    -------
    dict of RivalPair to float
        In noise floors, without those of which one does not run to the end.
    """
    found = {}
    for of, members in sets.items():
        runs = {name: rival.run(u, dt) for name, rival in members.items()}
        for one, other in combinations(members, 2):
            first, second = runs[one], runs[other]
            if first is not None and second is not None:
                found[RivalPair(of, (one, other))] = separation(
                    first, second, noise_floor
                )
    return found
