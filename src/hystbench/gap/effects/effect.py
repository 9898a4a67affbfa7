"""What an effect must say to be tried, in a chain or inside the dynamics."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, ClassVar, Literal, get_args

import numpy as np

from hystbench.blocks import block_class
from hystbench.blocks.base import Block, Place
from hystbench.blocks.forced import ForcedDynamics
from hystbench.blocks.held import HeldBlock, held_until_smooth
from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.blocks.wrapping import WrappingBlock
from hystbench.device_kinds import DEVICE_KINDS, DeviceKind, causes
from hystbench.errors import refuse_unknown
from hystbench.gap.effects.law import Changed, Filled, Law, Moved, Passed
from hystbench.gap.effects.places import BETWEEN_HALVES, places_between_halves
from hystbench.gap.effects.variant import Beside, Values, Variant, begun_from
from hystbench.gap.simulation.simulation import Simulation
from hystbench.gap.thresholds import UNNAMED_SHARE
from hystbench.gap.view_kinds import ViewKind
from hystbench.record import FloatArray


class Declined(Exception):  # noqa: N818  (an answer, not an error)
    """An effect cannot be judged on these records or in this chain; says why."""


class Effect(ABC):
    """One physical effect of the vocabulary."""

    name: ClassVar[str]
    place: ClassVar[Place]
    shows: ClassVar[ViewKind]
    """View in which an engineer looks for it first."""
    causes: ClassVar[Mapping[str, Sequence[DeviceKind]]] = {}
    """What usually causes it, and in which kinds of devices; where none are given, its
    rows of ``device_kinds.yaml``."""
    offsets: ClassVar[Mapping[str, tuple[tuple[str, str], ...]]] = {}
    """Name and unit of each offset as a number of the effect, by form, where its blocks
    are plain gains."""
    numbers: ClassVar[tuple[str, ...]] = ()
    """Parameters of its blocks that are numbers of the effect; by default all."""
    free_forms: ClassVar[tuple[str, ...]] = ()
    """Forms that bend to much of what is there, as a path does: no law."""
    like_noise: ClassVar[bool] = False
    """Whether it is a slow wander. As a signal beside the chain it is no effect if it
    takes less power than that of the noise: most instruments have slow noise."""
    laws: ClassVar[tuple[str, ...]] = ()
    """Blocks of other laws of the effect, beside the one that has its name."""
    taken_from: ClassVar[str] = ""
    """Parameter of a mechanism that may already contain this effect, as a spring may
    contain a weight."""
    special: ClassVar[bool] = False
    """Whether it is offered only where its cause can be, as a weight where something
    turns: of a tie with a law that any device may have it is the likelier."""

    def __init_subclass__(cls) -> None:
        """Refuse words that nobody would find.

        Raises
        ------
        InputError
            If a place, a view or a kind of device is none.
        """
        super().__init_subclass__()
        said: list[tuple[str, str, tuple[str, ...]]] = []
        if "place" in vars(cls):
            said.append(("place", cls.place, get_args(Place)))
        if "shows" in vars(cls):
            said.append(("shows", cls.shows, get_args(ViewKind)))
        for kinds in cls.causes.values():
            said += [("causes", kind, DEVICE_KINDS) for kind in kinds]
        for key, word, known in said:
            refuse_unknown(word, known, f"{cls.__name__}: {key}: {word!r}")

    def causes_in(self, kind: DeviceKind | None) -> tuple[str, ...]:
        """Give what usually causes it in a kind of device, or in any.

        Returns
        -------
        tuple of str
            Empty where such a device cannot have it, and where no cause is known.
        """
        rows = (self.causes or causes().get(self.name, {})).items()
        return tuple(cause for cause, kinds in rows if kind is None or kind in kinds)

    def possible_in(self, kind: DeviceKind | None) -> bool:
        """Tell whether a device of a kind can have it; any can if no cause is known."""
        return bool(self.causes_in(kind)) or not self.causes_in(None)

    @abstractmethod
    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Give the variants that make sense in a chain on its records.

        Raises
        ------
        Declined
            If there is none: why.
        """

    def every_variant(self, simulation: Simulation) -> Iterator[Variant]:
        """Give the variants, linear ones from the start that the chain has.

        Where the chain begins at rest, they are given again from the start of what
        operates. A device that is switched on begins at rest, whatever its first input
        is. One that operates about a point away from zero does not: what it remembers
        is as old as its slowest lag.

        Raises
        ------
        Declined
            As :meth:`variants`.
        """
        begun = start_of(simulation.chain)
        for variant in self.variants(simulation):
            if variant.is_linear and begun != "rest":
                yield begun_from(variant, begun)
                continue
            yield variant
            if variant.is_linear and never_at_rest(simulation.at(variant.start)):
                whole = all(record.repeats for record in simulation.records)
                yield begun_from(variant, "repeating" if whole else "settled")

    def inserted(
        self,
        simulation: Simulation,
        place: int,
        values: Callable[[Values], dict[str, Any]] = dict,
        *,
        law: str = "",
        form: str = "",
        **about: Any,
    ) -> Variant:
        """Give the variant that puts the effect's block before the block at a place.

        A block that wraps the hysteresis changes the chain from the hysteresis on.

        Parameters
        ----------
        simulation : Simulation
        place : int
        values : callable
            Gives the block's parameters from those that are searched and solved for.
        law : str
            Name of the block, where it is not the effect's.
        form : str
        **about
            Further fields of :class:`Variant`; by default all parameters that are
            searched and solved for are free.
        """
        block = block_class(law or self.name)
        start = place
        if issubclass(block, WrappingBlock) and simulation.hysteresis is not None:
            start = simulation.hysteresis
        between, rest = simulation.chain[start:place], simulation.chain[place:]

        hold = simulation.hold_at(place) if issubclass(block, HeldBlock) else None
        if hold == "zero-order" and issubclass(block, LinearBlock) and block.smooths:
            # No staircase comes to what stands behind it any more.
            rest = held_until_smooth(rest, "linear", was="zero-order")

        def build(given: Values) -> tuple[Block, ...]:
            own = values(given)
            if hold is not None:
                own = {"hold": hold, **own}
            return (*between, block.from_mapping(own), *rest)

        about.setdefault("free", (*about.get("grids", ()), *about.get("unit", ())))
        return Variant(
            self.name,
            BETWEEN_HALVES
            if place in places_between_halves(simulation)
            else self.place,
            form,
            start,
            build,
            (len(between),),
            is_linear=issubclass(block, LinearBlock),
            **about,
        )

    def added(
        self, simulation: Simulation, beside: Beside, *, form: str, **about: Any
    ) -> Variant:
        """Give the variant that adds a signal to the output of the chain."""
        end, nothing = len(simulation.chain), ()
        return Variant(
            self.name,
            self.place,
            form,
            end,
            lambda given: nothing,
            nothing,
            beside=beside,
            **about,
        )

    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Give the laws by which it acts inside a mechanism, with starts.

        Parameters
        ----------
        moved : Moved
            How the linear mechanism moves on the records.
        """
        yield from ()

    def vanishing(self, form: str, block: Any) -> Iterator[tuple[Block, str]]:
        """Give blocks of a law that are another effect, each without one number.

        Parameters
        ----------
        form : str
            The law.
        block : Block
            As it was fitted. One that has not the number is of another law.
        """
        yield from ()

    def without_itself(self, blocks: Sequence[Block]) -> tuple[Block, ...] | None:
        """Give blocks of the effect without what makes it one; none where all does.

        Numbers that are zero there are no longer free.
        """
        return None

    def other_laws(self, block: Any) -> Iterator[Law]:
        """Give laws of no more numbers than that of a block inside, begun as it is.

        Beside another effect they may do better than the law that did best alone.

        Parameters
        ----------
        block : Block
            Of this effect.
        """
        yield from ()

    def stored(self, filled: Filled) -> Iterator[Changed]:
        """Offer other numbers of stores in series."""
        yield from ()

    def around(self, passed: Passed) -> Iterator[Law]:
        """Give the laws by which it acts before or behind what has effects inside.

        Parameters
        ----------
        passed : Passed
            What passes through that model, a mechanism or stores.
        """
        yield from ()

    def curve(
        self,
        place: Literal["before", "behind"],
        form: str = "",
        *,
        law: str = "",
        also: Mapping[str, Any] | None = None,
        ranges: Mapping[str, tuple[float, float]] | None = None,
        **start: float,
    ) -> Law:
        """Give the effect's block before or behind what has effects inside.

        Parameters
        ----------
        place : {"before", "behind"}
        form : str
        law : str
            Name of the block, where it is not the effect's.
        also : mapping, optional
            Parameters that are not fitted.
        ranges : mapping of str to (float, float), optional
            Of its numbers, where beyond them it would be another effect.
        **start : float
            Its numbers, where their fit starts.
        """
        block = block_class(law or self.name).from_mapping({**(also or {}), **start})
        return Law(form, block, tuple(start), place, ranges=ranges or {})

    def describe(self, given: Values, amplitudes: FloatArray) -> dict[str, Any]:
        """Give the block of a signal beside, from its amplitudes (records, k)."""
        raise NotImplementedError


def start_of(chain: Sequence[Block]) -> str:
    """Give how the dynamics of a chain begin, of several the first not at rest.

    Its lags do not count: they may be effects, each with a start of its own.
    """
    dynamics = (x for x in chain if isinstance(x, TransferFunction | ForcedDynamics))
    return next((x.start for x in dynamics if x.start != "rest"), "rest")


def never_at_rest(signals: Sequence[FloatArray]) -> bool:
    """Tell whether a signal of some record keeps away from zero, on one side of it."""
    return any(len(z) > 0 and (z.min() > 0.0 or z.max() < 0.0) for z in signals)


def goes_both_ways(signals: Sequence[FloatArray]) -> bool:
    """Tell whether signals are on both sides of zero by a share of power that matters.

    Else a law that differs by side is a gain.
    """
    above = sum(float(np.sum(np.maximum(z, 0.0) ** 2)) for z in signals)
    below = sum(float(np.sum(np.minimum(z, 0.0) ** 2)) for z in signals)
    return min(above, below) > UNNAMED_SHARE * (above + below)


NOT_IN_CHAIN = (
    "it acts inside the dynamics: 'hystbench gap' tries it there, not in the chain; to "
    "put it in by hand, write it in the model file"
)
"""Why an effect that acts inside the dynamics has no place in a chain."""


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
        raise Declined(NOT_IN_CHAIN)


class StoreEffect(InsideEffect):
    """An effect of stores: their own numbers are other ones."""

    laws = ("store",)
