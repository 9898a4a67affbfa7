"""What a search tries of an effect: a place in the chain and a form.

A variant says how the blocks from that place on look for given values of its
parameters. Parameters that the output depends on in a curved way (a time constant, a
limit) are searched on a grid; those that scale a contribution (a magnitude) are solved
for.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from hystbench.blocks.base import Block
from hystbench.record import FloatArray

Values = Mapping[str, float]
SomeSamples = slice | NDArray[np.intp]
"""Some samples of a record."""
EVERY: SomeSamples = slice(None)
Refused = Literal["", "either", "lower", "upper"]
"""Ends of a number's range at which an effect is not accepted."""


@dataclass(frozen=True)
class Beside:
    """A signal that the input does not explain, new in every record."""

    effect: str
    order: int
    """How many shapes of it there are: harmonics, or the degree of a path."""
    columns: Callable[..., FloatArray]
    """``columns(record, values, order)`` gives the shapes, shape (n, k), and with a
    fourth argument those at some samples alone; each record has amplitudes of its
    own."""


@dataclass(frozen=True)
class Variant:
    """An effect at one place in one form."""

    effect: str
    place: str
    form: str
    start: int
    """The first block of the chain that changes."""
    build: Callable[[Values], tuple[Block, ...]]
    """Blocks from ``start`` on, from values of all parameters."""
    positions: tuple[int, ...]
    """Places of the effect's own blocks in what ``build`` gives."""
    grids: dict[str, FloatArray] = field(default_factory=dict)
    """Values to search, by parameter."""
    unit: dict[str, float] = field(default_factory=dict)
    """Parameters that are solved for, and a small step of each."""
    positive: tuple[str, ...] = ()
    """Those of ``unit`` that may not be negative."""
    free: tuple[str, ...] = ()
    """Parameters of the block that a refit may change."""
    beside: Beside | None = None
    """Added to the output of the chain, which stays as it is."""
    charge: float | None = None
    """Parameters to be charged, where it is not the number of those searched."""
    refused: dict[str, Refused] = field(default_factory=dict)
    """Parameters that at an end of their range make another thing of the effect: there
    it is not accepted."""
    replaces: bool = False
    """Whether the effect's block takes the place of the chain's at ``start``."""
    limits: dict[str, tuple[float, float]] = field(default_factory=dict)
    """Ends of the range of parameters, where they are not the grid's or the block's."""
    neutral: bool = True
    """Whether the chain is as before where all parameters solved for are zero."""
    zero: dict[str, float] | None = None
    """Values at which the chain is as before, but simulated in another way: only the
    difference to them is the effect's."""
    begun: bool = False
    """Whether a trial only begins it: the refit frees numbers that no trial has, so
    that the score of its trial says little."""
    is_linear: bool = False
    """Whether its block is linear dynamics."""
    operates: str = ""
    """How that starts, where it is not at rest."""

    def ends(self, name: str) -> tuple[float, float]:
        """Give the ends of a searched parameter's range."""
        if name in self.limits:
            return self.limits[name]
        axis = self.grids[name]
        return float(axis.min()), float(axis.max())

    @property
    def freedom(self) -> float:
        """Number of parameters that are charged."""
        own = len(self.grids) + len(self.unit)
        return own if self.charge is None else self.charge


def begun_from(variant: Variant, start: str) -> Variant:
    """Give a linear variant whose block has a start other than at rest."""
    (place,) = variant.positions

    def build(given: Values) -> tuple[Block, ...]:
        blocks = list(variant.build(given))
        own: Any = blocks[place]
        blocks[place] = replace(own, start=start)
        return tuple(blocks)

    return replace(variant, build=build, operates=start)


def logarithmic(low: float, high: float, per_decade: float = 2.5) -> FloatArray:
    """Give values from low to high, so many a decade, evenly in their logarithm."""
    count = max(2, int(np.ceil(np.log10(high / low) * per_decade)) + 1)
    return np.geomspace(low, high, count)
