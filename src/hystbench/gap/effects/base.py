"""What an effect must say so that the search can try it.

An effect offers variants: a place in the chain and a form. A variant says how the
blocks from that place on look for given values of its parameters. Parameters that the
output depends on in a curved way (a time constant, a limit) are searched on a grid;
those that scale a contribution (a magnitude) are solved for.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from hystbench.blocks import registry
from hystbench.blocks.base import Block
from hystbench.blocks.held import HeldBlock
from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.wrapping import WrappingBlock
from hystbench.gap.effects.law import Changed, Filled, Law, Moved
from hystbench.gap.effects.places import INSIDE, places_between_halves
from hystbench.gap.simulation.simulation import Simulation
from hystbench.gap.view_kinds import ViewKind
from hystbench.record import FloatArray

Values = Mapping[str, float]
SomeSamples = slice | NDArray[np.intp]
"""Some samples of a record."""
EVERY: SomeSamples = slice(None)


class Declined(Exception):  # noqa: N818  (an answer, not an error)
    """An effect cannot be judged on these records or in this chain; says why."""


Refused = Literal["", "either", "upper"]
"""Ends of a number's range at which an effect is not accepted."""


@dataclass(frozen=True)
class Beside:
    """A signal that the input does not explain, new in every record.

    Parameters
    ----------
    effect : str
    order : int
        How many shapes of it there are: harmonics, or the degree of a path.
    columns : callable
        ``columns(record, values, order)`` gives the shapes, shape (n, k), and with a
        fourth argument those at some samples alone; each record has amplitudes of its
        own.
    """

    effect: str
    order: int
    columns: Callable[..., FloatArray]


@dataclass(frozen=True)
class Variant:
    """An effect at one place in one form.

    Parameters
    ----------
    effect, place, form : str
    start : int
        The first block of the chain that changes.
    build : callable
        Blocks from ``start`` on, from values of all parameters.
    positions : tuple of int
        Where the effect's own blocks stand in what ``build`` gives.
    grids : dict of str to ndarray
        Values to search, by parameter.
    limits : dict of str to (float, float)
        Ends of the range of searched parameters, where they are not the grid's.
    unit : dict of str to float
        Parameters that are solved for, and a small step of each.
    positive : tuple of str
        Of these, the ones that may not be negative.
    free : tuple of str
        Parameters of the block that a refit may change.
    beside : Beside, optional
        Added to the output of the chain, which stays as it is.
    charge : float, optional
        Parameters to be charged, where it is not the number of those searched.
    refused : dict of str to {"either", "upper"}
        Searched parameters that at an end of their range make another thing of the
        effect: there it is not accepted.
    replaces : bool
        Whether the effect's block takes the place of the chain's at ``start``.
    neutral : bool
        Whether the chain is as before where all parameters solved for are zero.
    zero : dict of str to float, optional
        Values at which the chain is as before, but simulated in another way: only the
        difference to them is the effect's.
    begun : bool
        Whether a trial only begins it: the refit frees numbers that no trial has, so
        that the score of its trial says little.
    is_linear : bool
        Whether its block is linear dynamics.
    operates : str
        How that starts, where it is not at rest.
    """

    effect: str
    place: str
    form: str
    start: int
    build: Callable[[Values], tuple[Block, ...]]
    positions: tuple[int, ...]
    grids: dict[str, FloatArray] = field(default_factory=dict)
    unit: dict[str, float] = field(default_factory=dict)
    positive: tuple[str, ...] = ()
    free: tuple[str, ...] = ()
    beside: Beside | None = None
    charge: float | None = None
    refused: dict[str, Refused] = field(default_factory=dict)
    replaces: bool = False
    limits: dict[str, tuple[float, float]] = field(default_factory=dict)
    neutral: bool = True
    zero: dict[str, float] | None = None
    begun: bool = False
    is_linear: bool = False
    operates: str = ""

    def ends(self, name: str) -> tuple[float, float]:
        """Give the ends of a searched parameter's range."""
        axis = self.grids[name]
        return self.limits.get(name, (float(axis.min()), float(axis.max())))

    @property
    def freedom(self) -> float:
        """Number of parameters that are charged."""
        own = len(self.grids) + len(self.unit)
        return own if self.charge is None else self.charge

    @property
    def label(self) -> str:
        """The effect, with its form where it has several."""
        return f"{self.effect} ({self.form})" if self.form else self.effect


class Effect(ABC):
    """One physical effect of the vocabulary."""

    name: ClassVar[str]
    place: ClassVar[str]
    shows: ClassVar[ViewKind]
    """View in which an engineer looks for it first."""
    offsets: ClassVar[Mapping[str, tuple[tuple[str, str], ...]]] = {}
    """By form, where its blocks are plain gains: the name and the unit that the offset
    of each has as a number of the effect."""
    numbers: ClassVar[tuple[str, ...]] = ()
    """Of its blocks, the parameters that are numbers of the effect; by default all."""
    free_forms: ClassVar[tuple[str, ...]] = ()
    """Forms that bend to much of what is there, as a path does: no law."""
    laws: ClassVar[tuple[str, ...]] = ()
    """Blocks of other laws of the effect, beside the one that has its name."""
    vanishing: ClassVar[str] = ""
    """Of its block inside the dynamics: without this number it is another effect."""
    special: ClassVar[bool] = False
    """Whether it is offered only where its cause can be, as a weight where something
    turns: of a tie with a law that any device may have it is the likelier."""

    @abstractmethod
    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Give the variants that make sense in a chain on its records.

        Raises
        ------
        Declined
            If there is none: why.
        """

    def every_variant(self, simulation: Simulation) -> Iterator[Variant]:
        """Give the variants, and linear ones again from the start of what operates.

        A device that is switched on begins at rest, whatever its first input is. One
        that operates about a point away from zero does not: what it remembers is as old
        as its slowest lag.

        Raises
        ------
        Declined
            As :meth:`variants`.
        """
        for variant in self.variants(simulation):
            yield variant
            if variant.is_linear and never_at_rest(simulation.at(variant.start)):
                yield in_operation(variant, simulation)

    def inserted(
        self,
        simulation: Simulation,
        place: int,
        values: Callable[[Values], dict[str, Any]] = dict,
        *,
        law: str = "",
        form: str = "",
        grids: dict[str, FloatArray] | None = None,
        unit: dict[str, float] | None = None,
        positive: tuple[str, ...] = (),
        free: tuple[str, ...] = (),
        refused: dict[str, Refused] | None = None,
        limits: dict[str, tuple[float, float]] | None = None,
        neutral: bool = True,
        zero: dict[str, float] | None = None,
    ) -> Variant:
        """Give the variant that puts the effect's block before the block at a place.

        A block that wraps the hysteresis changes the chain from the hysteresis on. The
        block has the effect's name, or that of another law of it.
        """
        block = registry()[law or self.name]
        start = place
        if issubclass(block, WrappingBlock) and simulation.hysteresis is not None:
            start = simulation.hysteresis
        between, rest = simulation.chain[start:place], simulation.chain[place:]

        hold = simulation.hold_at(place) if issubclass(block, HeldBlock) else None

        def build(given: Values) -> tuple[Block, ...]:
            own = values(given)
            if hold is not None:
                own = {"hold": hold, **own}
            return (*between, block.from_mapping(own), *rest)

        return Variant(
            self.name,
            INSIDE if place in places_between_halves(simulation) else self.place,
            form,
            start,
            build,
            (len(between),),
            grids or {},
            unit or {},
            positive,
            free or (*(grids or {}), *(unit or {})),
            refused=refused or {},
            limits=limits or {},
            neutral=neutral,
            zero=zero,
            is_linear=issubclass(block, LinearBlock),
        )

    def added(
        self,
        simulation: Simulation,
        beside: Beside,
        *,
        form: str,
        charge: float,
        grids: dict[str, FloatArray] | None = None,
    ) -> Variant:
        """Give the variant that adds a signal to the output of the chain."""
        end = len(simulation.chain)
        return Variant(
            self.name,
            self.place,
            form,
            end,
            lambda given: (),
            (),
            grids or {},
            beside=beside,
            charge=charge,
        )

    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Give the laws by which it acts in, before or behind a mechanism, with starts.

        Parameters
        ----------
        moved : Moved
            How the linear mechanism moves on the records.
        """
        yield from ()

    def stored(self, filled: Filled) -> Iterator[Changed]:
        """Offer other numbers of stores in series.

        Parameters
        ----------
        filled : Filled
        """
        yield from ()

    def around_mechanism(
        self, moved: Moved, name: str, place: Literal["before", "behind"], **given: str
    ) -> Law:
        """Give the effect's filter before or behind a mechanism.

        It starts short against the records' rates: at two sampling intervals. Less than
        one is no effect but how input and output were sampled.

        Parameters
        ----------
        moved : Moved
        name : str
            The time that is fitted.
        place : {"before", "behind"}
        **given
            Other parameters.
        """
        block = registry()[self.name].from_mapping({name: 2 * moved.step, **given})
        return Law("", block, (name,), place, ranges={name: (moved.step, np.inf)})

    def curve(
        self,
        place: Literal["before", "behind"],
        form: str = "",
        also: Mapping[str, float] | None = None,
        **start: float,
    ) -> Law:
        """Give the effect's curve or play before or behind a mechanism.

        Parameters
        ----------
        place : {"before", "behind"}
        form : str
        also : mapping of str to float, optional
            Numbers that are not fitted.
        **start : float
            Those that are, where their fit starts.
        """
        block = registry()[self.name].from_mapping({**(also or {}), **start})
        return Law(form, block, tuple(start), place)

    def describe(self, given: Values, amplitudes: FloatArray) -> dict[str, Any]:
        """Give the block of a signal beside, from its amplitudes (records, k)."""
        raise NotImplementedError


def never_at_rest(signals: Sequence[FloatArray]) -> bool:
    """Tell whether a signal of some record keeps away from zero, on one side of it."""
    return any(len(z) > 0 and (z.min() > 0.0 or z.max() < 0.0) for z in signals)


def in_operation(variant: Variant, simulation: Simulation) -> Variant:
    """Give a linear variant that has operated before its records began.

    Whole periods of an input came before; else the first value has stood there.
    """
    whole = all(record.repeats for record in simulation.records)
    start: Any = "repeating" if whole else "settled"
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


class InsideEffect(Effect):
    """An effect that acts inside the dynamics and nowhere else."""

    place = "inside"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Decline: no chain in series has a place for it.

        Raises
        ------
        Declined
            Always.
        """
        raise Declined("it acts inside the dynamics, where it is tried apart")


class StoreEffect(InsideEffect):
    """An effect of stores: their own numbers are other ones."""

    laws = ("store",)

    @abstractmethod
    def stored(self, filled: Filled) -> Iterator[Changed]:
        """Give the numbers, as every effect may."""


class ForceEffect(InsideEffect):
    """An effect that acts inside a mechanism."""

    @abstractmethod
    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Give the laws, as every effect may."""
