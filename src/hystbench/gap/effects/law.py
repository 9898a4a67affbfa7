"""How an effect acts inside the dynamics: what it is told of them, what it answers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal, NamedTuple

from hystbench.blocks.base import Block
from hystbench.blocks.store import Store


@dataclass(frozen=True)
class Moved:
    """How a mechanism moves, the largest magnitudes over all records."""

    reach: float
    """Largest distance of its position from the middle."""
    speed: float
    """Largest velocity."""
    force: float
    """Largest force that drives it, or that its motion takes."""
    turns: str = ""
    """The unit of its position where that is an angle: rad or deg."""
    anywhere: bool = False
    """Whether where it is does not matter, as of a mass without a spring: a force that
    depends on the place has no meaning then."""
    stiffness: float = 0.0
    """Stiffness of its linear spring, and of a weight; zero without either."""
    loose: bool = False
    """Whether nobody knows that it has a spring."""
    known: bool = False
    """Whether its spring is known, as of a base that was given."""


class Passed(NamedTuple):
    """What passes through a model: the largest of its input and of its output."""

    given: float
    shown: float
    step: float
    """Shortest sampling interval, in seconds."""
    shortest: float
    """Time from which on a lag or a delay is an effect, in seconds. In a model that was
    identified from the records, less than an interval is how input and output were
    sampled."""
    both_ways: bool = True
    """Whether the input goes to both sides of zero."""


@dataclass(frozen=True)
class Law:
    """A force inside a mechanism, or a block before or behind it, as a fit starts."""

    form: str
    """What tells it from other laws of the effect."""
    block: Block
    free: tuple[str, ...]
    """Parameters that are fitted."""
    place: Literal["inside", "before", "behind"] = "inside"
    stands_for: float = 0.0
    """Share of the linear spring that the force stands for: it goes out of the spring.
    Of one it is all of it, and no spring is left."""
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Ranges of its numbers; beyond them it would be another effect."""


class Filled(NamedTuple):
    """How high stores are filled."""

    tops: tuple[tuple[int, Store, float], ...]
    """Place, block and highest simulated level of each."""
    measured: float | None = None
    """Highest measured level of the last one, where its level is the output."""
    known: bool = False
    """Whether a given base states their numbers."""


class Changed(NamedTuple):
    """Other numbers of stores, where their fit starts."""

    form: str
    """What tells it from other laws of the effect."""
    values: dict[int, dict[str, float]]
    """The numbers, by place and parameter."""
    free: tuple[tuple[int, str], ...]
    """Place and parameter of each number that is fitted."""
    ranges: Mapping[tuple[int, str], tuple[float, float]] = MappingProxyType({})
    """Of those whose range is not the block's own."""
