"""Linear hosts: what forces can act inside of, fitted without any of them.

Where the base was identified from the records, hosts are fitted to them too. A base
that a user gives stands for itself: a host takes its place only if it simulates the
same, as a mass on a spring does in whatever way it was written. Stores alone may stand
in place of a base that does something else, which is then said.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from itertools import product
from typing import Any

import numpy as np

from hystbench.blocks.attached_mass import AttachedMass
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
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.inside.first_order import both_readings, of_first_order
from hystbench.gap.inside.given_hosts import as_given, held_about, is_seen_moving
from hystbench.gap.inside.host import Host, Kind
from hystbench.gap.inside.host_places import host_of, host_places, own_numbers
from hystbench.gap.inside.joint import structure
from hystbench.gap.inside.linear_stores import store_hosts
from hystbench.gap.inside.one_coordinate import (
    BEGUN,
    MOTIONS,
    best_host,
    free_masses,
    likeliest,
    one_coordinate,
    same_as,
)
from hystbench.gap.inside.timing import in_front, with_free_timing
from hystbench.gap.thresholds import PARAMETER, PAYS
from hystbench.quantities import Quantities


def hosts(
    start: ModelState,
    quantities: Quantities,
    identified: bool,
    score: Score,
    exact: bool = False,
    timed: bool = False,
    kinds: Collection[Kind] = (),
) -> Iterator[Host]:
    """Give the linear models that forces are tried in.

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
    timed : bool
        Whether the input was moved in time already.
    kinds : collection of str
        Those that are wanted; all by default.
    """

    def wanted(*some: Kind) -> bool:
        return not kinds or any(kind in kinds for kind in some)

    @cache
    def modes() -> ModelState | None:
        """Give the base as a structure where a force makes a motion."""
        if quantities.causality not in ("force to motion", "unknown"):
            return None
        known = quantities.output in MOTIONS
        return structure(start, quantities.output if known else "position", identified)

    about = quantities, identified, score
    delay = start.chain[0]
    if identified and isinstance(delay, InputDelay):
        for host in hosts(_behind(start), *about, timed=True, kinds=kinds):
            state = _in_front(delay, start, host.fitted.state)
            alone = _in_front(delay, start, host.alone)
            other = host.unfitted_start
            other = other and _in_front(delay, start, other)
            whole = replace(host.fitted, state=state)
            yield replace(host, alone=alone, fitted=whole, unfitted_start=other)
        # A force that is not linear turns the phase: it may be what looked like timing.
        yield from hosts(_without_timing(start), *about, kinds=kinds)
        return
    stored = quantities.causality in ("storage", "unknown")
    if stored and not exact and wanted("stores"):
        yield from store_hosts(start, identified, score)
    # Of a mass that follows at once only its spring is seen: a force inside is then a
    # curve or a loop of what drives it, which a chain has.
    shows_a_pole = not all(isinstance(block, Gain) for block in start.chain)
    moves = shows_a_pole or quantities.causality == "motion to force"
    of_masses = wanted("coordinate", "loose mass", "two masses")
    if identified and moves and not of_many_modes(start) and of_masses:
        begun = one_coordinate(start.records, quantities, start.hold)
        best = best_host(begun, score)
        if best is not None and is_seen_moving(best.state):
            words = "a model of one coordinate stands in place of the linear base"
            if wanted("coordinate"):
                yield Host(best.state, best, words)
                if not timed:
                    yield from _in_time(best, score)
                if quantities.output not in MOTIONS and of_first_order(start):
                    yield from both_readings(best.state, score)
            if wanted("loose mass"):
                yield from _loose(best.state, score, words)
            # Two masses that both swing are a structure that is driven at its joint.
            if wanted("two masses") and not _of_two_modes(modes()):
                yield from _of_two(best, further_modes_of(start), score)
    behind_timing = start.chain[isinstance(delay, InputDelay) :]
    of_stores = behind_timing and all(isinstance(x, Store) for x in behind_timing)
    if of_stores and not identified:
        words = "the base is stores already"
        yield Host(start, fitted(start, score), words, kind="stores")
        return
    if not identified and wanted("given"):
        words = "the base holds what forces act in"
        same = own_mechanism(start)
        if same is None:
            words = (
                "a model of one coordinate that simulates the same stands for the base"
            )
            same = same_as(start, quantities, score.floor)
        if same is not None:
            own = same, held_about(same), score, words, start.free, exact
            yield from as_given("given", *own)
    whole_base = modes() if wanted("structure") else None
    words = "the modes of the base move one joint"
    if whole_base is not None and identified:
        best = fitted(whole_base, score)
        yield Host(best.state, best, words, kind="structure")
    elif whole_base is not None:
        own = whole_base, whole_base, score, words, start.free, exact
        yield from as_given("structure", *own)


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


def _of_two(one: Fitted, frequencies: Sequence[float], score: Score) -> Iterator[Host]:
    """Give a mass with another one attached, where that pays as an effect does."""
    state = one.state
    block = state.chain[0]
    if not (frequencies and isinstance(block, Mechanism)):
        return
    loose = free_masses(state.records, block.output, state.hold)
    best = best_host(two_masses([state, *loose], frequencies), score)
    if best is not None and best.score < one.score - PAYS:
        words = "a mass with another one attached stands in place of the linear base"
        yield Host(best.state, best, words, kind="two masses")


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


SHARES = (0.2, 0.5, 0.8)
"""Shares of the mass that is attached."""
RATIO = 0.05
"""Damping ratio with which they are begun."""


def two_masses(
    hosts: Iterable[ModelState], frequencies: Sequence[float]
) -> Iterator[ModelState]:
    """Write masses as two of as much together, which swing against each other.

    What friction or a clearance holds at the driven side of a flexible shaft acts on
    the motion of both modes: of the mass as a whole, and of the two against each other.

    Parameters
    ----------
    hosts : iterable of ModelState
        Each begins with a mechanism; further blocks do not depend on what enters them.
    frequencies : sequence of float
        At which the two are begun, in rad/s.

    Yields
    ------
    ModelState
        With all numbers of both masses free.
    """
    found: list[tuple[float, int, ModelState]] = []
    for host in hosts:
        for w, share in product(frequencies, SHARES):
            begun = _sized(_split(host, w, share))
            if begun is not None:
                rest = float(np.mean(begun.residual**2))
                found.append((rest, len(found), begun))
    for _, _, state in sorted(found)[:BEGUN]:
        yield state


def further_modes_of(base: ModelState) -> list[float]:
    """Give the frequencies, in rad/s, at which a base swings beside one coordinate.

    It has two poles of one coordinate; those of a further mode were asked for by
    folds, as those that only imitate friction are not.
    """
    poles = [
        pole
        for block in base.chain
        if isinstance(block, TransferFunction)
        for pole in np.roots(block.denominator)
    ]
    if len(poles) < 3:
        return []
    return [float(abs(pole)) for pole in poles if pole.imag > 0]


def _split(state: ModelState, frequency: float, share: float) -> ModelState:
    """Attach a share of the mass of a mechanism to the rest of it."""
    whole, *behind = state.chain
    assert isinstance(whole, Mechanism)  # noqa: S101  (for the type checker)
    own, attached = (1 - share) * whole.mass, share * whole.mass
    reduced = own * share
    other = AttachedMass(
        mass=attached,
        damping=2 * RATIO * frequency * reduced,
        stiffness=frequency**2 * reduced,
    )
    split = rearranged(
        state,
        (replace(whole, mass=own), other, *behind),
        {k: k + (k > 0) for k in range(len(state.chain))},
    )
    free = (*split.free, *(Free(1, name) for name in AttachedMass.parameters()))
    return replace(split, free=free).settled()


def _sized(state: ModelState) -> ModelState | None:
    """Give two masses the size that fits best; None if they would move backwards."""
    output = state.sample.take(state.simulation.output)
    columns = np.column_stack([output, np.ones(len(output))])
    if not np.all(np.isfinite(columns)):
        return None
    gain = float(np.linalg.lstsq(columns, state.measured, rcond=1e-10)[0][0])
    if gain <= 0.0:
        return None
    return state.with_blocks({k: _over(state.chain[k], gain) for k in (0, 1)})


def _over(block: Block, gain: float) -> Block:
    """Divide a mass, its damper and its spring by a number."""
    numbers: dict[str, Any] = {
        name: getattr(block, name) / gain for name in ("mass", "damping", "stiffness")
    }
    return replace(block, **numbers)
