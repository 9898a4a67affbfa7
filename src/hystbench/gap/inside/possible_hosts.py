"""Linear hosts: what forces can act inside of, fitted without any of them.

Where the base was identified from the records, hosts are fitted to them too. A base
that a user gives stands for itself: a host takes its place only if it simulates the
same, as a mass on a spring does in whatever way it was written. Stores alone may stand
in place of a base that does something else, which is then said.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

from hystbench.blocks.base import Block
from hystbench.blocks.force import Force
from hystbench.blocks.gain import Gain
from hystbench.blocks.input_delay import InputDelay
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.store import Store
from hystbench.blocks.structure import Structure
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases.orders import HIGHEST
from hystbench.gap.bases.roughly_known import stated
from hystbench.gap.fitting.edit_chain import rearranged
from hystbench.gap.fitting.least_squares import Fitted, fitted
from hystbench.gap.fitting.on_records import free_within
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.first_order import both_readings, of_first_order
from hystbench.gap.inside.given_hosts import as_given, held_about, is_seen_moving
from hystbench.gap.inside.host import Host, Kind
from hystbench.gap.inside.host_places import host_of, host_places, own_numbers
from hystbench.gap.inside.joint import structure
from hystbench.gap.inside.linear_stores import store_hosts
from hystbench.gap.inside.one_coordinate import (
    MOTIONS,
    best_host,
    free_masses,
    likeliest,
    one_coordinate,
    same_as,
)
from hystbench.gap.inside.timing import in_front, with_free_timing
from hystbench.gap.inside.two_masses import further_modes_of, of_two_masses
from hystbench.gap.thresholds import PARAMETER
from hystbench.quantities import Quantities


def hosts(
    start: ModelState,
    quantities: Quantities,
    identified: bool,
    score: Score,
    exact: bool = False,
    kinds: Collection[Kind] = (),
) -> Iterator[Host]:
    """Give the linear models that forces are tried in.

    Of an identified base that takes its input late or early, hosts behind that timing
    come first, then hosts without it.

    Parameters
    ----------
    start : ModelState
        The base on the fit records.
    quantities : Quantities
        What the device takes and gives.
    identified : bool
        Whether the base was identified from the records.
    score : Score
    exact : bool
        Whether a given base calls its numbers exact.
    kinds : collection of str
        Those that are wanted; all by default.
    """
    wanted = PossibleHosts(start, quantities, identified, score, exact, kinds)
    delay = start.chain[0]
    if not (identified and isinstance(delay, InputDelay)):
        yield from wanted.every()
        return
    for host in replace(wanted, start=_behind(start), timed=True).every():
        state = _in_front(delay, start, host.fitted.state)
        alone = _in_front(delay, start, host.alone)
        other = host.unfitted_start
        other = other and _in_front(delay, start, other)
        whole = replace(host.fitted, state=state)
        yield replace(host, alone=alone, fitted=whole, unfitted_start=other)
    # A force that is not linear turns the phase: it may be what looked like timing.
    yield from replace(wanted, start=_without_timing(start)).every()


@dataclass(frozen=True)
class PossibleHosts:
    """Linear models that stand for a base, as told in :func:`hosts`, by their kinds."""

    start: ModelState
    quantities: Quantities
    identified: bool
    score: Score
    exact: bool
    kinds: Collection[Kind]
    timed: bool = False
    """Whether the input was moved in time already."""

    def wants(self, *some: Kind) -> bool:
        """Tell whether hosts of one of these kinds are wanted."""
        return not self.kinds or any(kind in self.kinds for kind in some)

    def every(self) -> Iterator[Host]:
        """Give those of each kind that is wanted."""
        if self.wants("stores"):
            yield from self.fitted_stores()
        if self.wants("coordinate", "loose mass", "two masses"):
            yield from self.masses()
        delays = isinstance(self.start.chain[0], InputDelay)
        behind_timing = self.start.chain[delays:]
        of_stores = behind_timing and all(isinstance(x, Store) for x in behind_timing)
        if of_stores and not self.identified:
            own = fitted(self.start, self.score)
            yield Host(self.start, own, "the base is stores already", kind="stores")
            return
        if self.wants("given"):
            yield from self.given()
        if self.wants("structure"):
            yield from self.structures()

    def fitted_stores(self) -> Iterator[Host]:
        """Give stores, unless the base calls its numbers exact."""
        if self.quantities.causality in ("storage", "unknown") and not self.exact:
            yield from store_hosts(self.start, self.identified, self.score)

    def masses(self) -> Iterator[Host]:
        """Give masses that are fitted to the records of an identified base."""
        # Of a mass that follows at once only its spring is seen: a force inside is then
        # a curve or a loop of what drives it, which a chain has.
        shows_a_pole = not all(isinstance(block, Gain) for block in self.start.chain)
        moves = shows_a_pole or self.quantities.causality == "motion to force"
        if not (self.identified and moves) or of_many_modes(self.start):
            return
        begun = one_coordinate(self.start.records, self.quantities, self.start.hold)
        best = best_host(begun, self.score)
        if best is None or not is_seen_moving(best.state):
            return
        words = "a model of one coordinate stands in place of the linear base"
        if self.wants("coordinate"):
            yield Host(best.state, best, words)
            if not self.timed:
                yield from _in_time(best, self.score)
            if self.quantities.output not in MOTIONS and of_first_order(self.start):
                yield from both_readings(best.state, self.score)
        if self.wants("loose mass"):
            yield from _loose(best.state, self.score, words)
        # Two masses that both swing are a structure that is driven at its joint.
        if self.wants("two masses") and not _of_two_modes(self.modes):
            yield from of_two_masses(best, further_modes_of(self.start), self.score)

    def given(self) -> Iterator[Host]:
        """Give what a given base holds, or one coordinate that simulates the same."""
        if self.identified:
            return
        words = "the base holds what forces act in"
        same = own_mechanism(self.start)
        if same is None:
            words = (
                "a model of one coordinate that simulates the same stands for the base"
            )
            same = same_as(self.start, self.quantities, self.score.floor)
        if same is not None:
            yield from self.as_it_is("given", same, held_about(same), words)

    @cached_property
    def modes(self) -> ModelState | None:
        """The base as a structure, where a force makes a motion."""
        if self.quantities.causality not in ("force to motion", "unknown"):
            return None
        output = self.quantities.output
        seen = output if output in MOTIONS else "position"
        return structure(self.start, seen, self.identified)

    def structures(self) -> Iterator[Host]:
        """Give the modes of the base, if it has any that move one joint."""
        modes, words = self.modes, "the modes of the base move one joint"
        if modes is not None and self.identified:
            best = fitted(modes, self.score)
            yield Host(best.state, best, words, kind="structure")
        elif modes is not None:
            yield from self.as_it_is("structure", modes, modes, words)

    def as_it_is(
        self, kind: Kind, state: ModelState, about: ModelState, words: str
    ) -> Iterator[Host]:
        """Give a host that does what a given base does, then the same fitted."""
        own = self.score, words, self.start.free, self.exact
        yield from as_given(kind, state, about, *own)


def _of_two_modes(state: ModelState | None) -> bool:
    """Tell whether a model is a structure of two modes or more."""
    return state is not None and any(
        isinstance(block, Structure) and len(block.stiffness) > 1
        for block in state.chain
    )


def _loose(state: ModelState, score: Score, words: str) -> Iterator[Host]:
    """Give a mass without a spring, where another mass was fitted to its acceleration.

    A loose mass under a drag or a friction looks like one on a soft spring whose output
    has a share of the velocity: a force begins far from itself there. It comes last, as
    a friction that gives way before it slides is a spring to it.
    """
    block = state.chain[0]
    if not (isinstance(block, Mechanism) and block.output == "acceleration"):
        return
    alone = likeliest(free_masses(state.records, block.output, state.hold), score)
    if alone is not None:
        yield Host(alone.state, alone, words, kind="loose mass")


def _in_time(one: Fitted, score: Score) -> Iterator[Host]:
    """Give a model of one coordinate that may take its input late, where that fits.

    An output with a share of the next derivative turns the phase as a delay does, but
    a force beside the wrong one of the two is not told right: so it is one or the
    other.
    """
    late = fitted(_with_timing(one.state), score)
    more = len(late.state.free) - len(one.state.free)
    if late.score < one.score - PARAMETER * more:
        words = (
            "a model of one coordinate with a timing of its own stands in place of the "
            "linear base"
        )
        yield Host(late.state, late, words, carry=_with_timing)


def _with_timing(state: ModelState) -> ModelState:
    """Let a model of one coordinate take its input late, in place of a zero."""
    place = host_of(state)
    if isinstance(state.chain[place], Mechanism):
        free = (x for x in state.free if (x.block, x.parameter) != (place, "blend"))
        state = state.with_values({place: {"blend": 0.0}})
        state = replace(state, free=tuple(free))
    return with_free_timing(state)


def _behind(start: ModelState) -> ModelState:
    """Give a base without the timing of its input, on records that have it in time."""
    delay = start.chain[0]
    records = tuple(
        replace(item, u=delay.simulate(item.u, item.u, item.dt))
        for item in start.records
    )
    return replace(_without_timing(start), records=records).settled()


def _without_timing(start: ModelState) -> ModelState:
    """Give a base without the timing of its input, on the records as they are."""
    moved = {k: k - 1 for k in range(1, len(start.chain))}
    return rearranged(start, start.chain[1:], moved).settled()


def _in_front(delay: Block, start: ModelState, state: ModelState) -> ModelState:
    """Give a model of such records on those of a base, with the timing of its input."""
    return replace(in_front(delay, state), records=start.records).settled()


def own_mechanism(start: ModelState) -> ModelState | None:
    """Give a base that holds a mechanism itself, with its numbers and its forces' free.

    A force that is given is known no better than the mass that it acts on.
    """
    places = host_places(start.chain)
    if len(places) != 1:
        return None
    if start.free:
        return start
    (place,) = places
    forces = (
        free
        for k, block in enumerate(start.chain)
        if isinstance(block, Force)
        for name in stated(block)
        for free in free_within(k, name, getattr(block, name), None)
        if start.value(free) != 0.0
    )
    return replace(start, free=(*own_numbers(start, place), *forces))


def of_many_modes(start: ModelState) -> bool:
    """Tell whether a base has more poles than a force can have bought it.

    Friction in one coordinate buys a linear model an order or two, not further modes
    that folds ask for.
    """
    return any(
        isinstance(block, TransferFunction) and len(block.denominator) > HIGHEST + 1
        for block in start.chain
    )
