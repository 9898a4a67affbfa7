"""How an effect acts inside the dynamics: what it is told of them, what it answers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from hystbench.blocks.base import Block
from hystbench.blocks.store import Store


@dataclass(frozen=True)
class Moved:
    """How a mechanism moves, the largest magnitudes over all records.

    Parameters
    ----------
    reach : float
        Of its position about the middle.
    speed : float
        Of its velocity.
    force : float
        Of the force that drives it, or that its motion takes.
    turns : bool
        Whether it turns: its position is an angle in rad.
    anywhere : bool
        Whether where it is does not matter, as of a mass without a spring: a force
        that depends on the place has no meaning then.
    stiffness : float
        Of its linear spring; zero without one.
    """

    reach: float
    speed: float
    force: float
    turns: bool = False
    anywhere: bool = False
    stiffness: float = 0.0


class Passed(NamedTuple):
    """What passes through a model: the largest of its input and of its output.

    Parameters
    ----------
    given, shown : float
    step : float
        Shortest sampling interval, in seconds.
    shortest : float
        Time from which on a lag or a delay is an effect, in seconds. In a model that
        was identified from the records, less than an interval is how input and output
        were sampled.
    """

    given: float
    shown: float
    step: float
    shortest: float


@dataclass(frozen=True)
class Law:
    """A force inside a mechanism, or what is before or behind a host, as a fit starts.

    Parameters
    ----------
    form : str
        What tells it from other laws of the effect.
    block : Block
    free : tuple of str
        Parameters that are fitted.
    place : {"inside", "before", "behind"}
    stands_for : float
        Share of the linear spring that the force stands for: it goes out of the spring.
    ranges : mapping of str to (float, float)
        Of its numbers, where beyond them it would be another effect.
    """

    form: str
    block: Block
    free: tuple[str, ...]
    place: Literal["inside", "before", "behind"] = "inside"
    stands_for: float = 0.0
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)


class Filled(NamedTuple):
    """How high stores are filled: place, block and highest level of each.

    Of the last one, where its level is the output, also the highest that was measured.
    They are known if a given base states their numbers.
    """

    tops: tuple[tuple[int, Store, float], ...]
    measured: float | None = None
    known: bool = False


class Changed(NamedTuple):
    """Other numbers of stores, where their fit starts.

    Of them those that are free, by place and parameter.
    """

    form: str
    values: dict[int, dict[str, float]]
    free: tuple[tuple[int, str], ...]
