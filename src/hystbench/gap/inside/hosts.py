"""Linear hosts: what forces can act inside of, fitted without any of them.

Where the base was identified from the records, hosts are fitted to them too. A base
that a user gives stands for itself: a host takes its place only if it simulates the
same, as a mass on a spring does in whatever way it was written. Stores alone may stand
in place of a base that does something else, which is then said.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.gain import Gain
from hystbench.blocks.held import Hold
from hystbench.blocks.impedance import NUMBERS, Impedance
from hystbench.blocks.input_delay import InputDelay
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.store import Store
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases.orders import HIGHEST
from hystbench.gap.cache import records_digest
from hystbench.gap.fitting.least_squares import QUICK, Fitted, fitted, fitted_to_the_end
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.inside.laws import host_places
from hystbench.gap.inside.modes import frequency_of, modes
from hystbench.gap.inside.one_coordinate import (
    MOTIONS,
    free_masses,
    one_coordinate,
    solved,
)
from hystbench.gap.inside.stores import in_other_order, stores
from hystbench.gap.inside.two_masses import further_modes_of, two_masses
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.thresholds import ABOUT, AS_GOOD, FURTHER, PAYS
from hystbench.quantities import Quantities
from hystbench.record import Record

STORES = {1: "a store stands", 2: "two stores in series stand"}
"""How many are tried, and how that is told."""
ZEROS = ("bias", "offset", "delay_s")
"""Numbers that are counted from a zero: a share of them says nothing."""
TRIED = 2
"""Modes of a base in which forces are tried, those that need it most."""


@dataclass(frozen=True)
class Host:
    """A linear model that forces may act inside of."""

    alone: ModelState
    """What the gap is counted from."""
    fitted: Fitted
    """The same, its numbers fitted to the records: what forces are put in."""
    words: str
    """How it stands in place of the base."""
    other: ModelState | None = None
    """What forces are put in instead: as good while linear, and not fitted, as a fit
    would come back."""
    charge: float = 0.0
    """For numbers of a given base that are fitted though nobody set them free."""

    @property
    def counts(self) -> int:
        """As how many effects it counts: one if known numbers are fitted."""
        return int(self.charge > 0.0)


def hosts(
    start: ModelState,
    quantities: Quantities,
    identified: bool,
    score: Score,
    exact: bool = False,
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
    """
    delay = start.chain[0]
    if identified and isinstance(delay, InputDelay):
        for host in hosts(_behind(start), quantities, identified, score):
            state = _in_front(delay, start, host.fitted.state)
            alone = _in_front(delay, start, host.alone)
            other = host.other and _in_front(delay, start, host.other)
            whole = replace(host.fitted, state=state)
            yield replace(host, alone=alone, fitted=whole, other=other)
        # A force that is not linear turns the phase: it may be what looked like timing.
        yield from hosts(_without_timing(start), quantities, identified, score)
        return
    if quantities.causality in ("storage", "unknown") and not exact:
        yield from _of_stores(start, identified, score)
    # Of a mass that follows at once only its spring is seen: a force inside is then a
    # curve or a loop of what drives it, which a chain has.
    shows_a_pole = not all(isinstance(block, Gain) for block in start.chain)
    moves = shows_a_pole or quantities.causality == "motion to force"
    if identified and moves and not of_many_modes(start):
        begun = one_coordinate(start.records, quantities, start.hold)
        best = best_host(begun, score)
        if best is not None and is_seen_moving(best.state):
            words = "a model of one coordinate stands in place of the linear base"
            yield Host(best.state, best, words)
            yield from _loose(best.state, score, words)
            yield from _of_two(best, further_modes_of(start), score)
    if not identified and all(isinstance(block, Store) for block in start.chain):
        yield Host(start, fitted(start, score), "the base is stores already")
        return
    if not identified:
        words = "the base holds a mechanism"
        same = own_mechanism(start)
        if same is None:
            words = (
                "a model of one coordinate that simulates the same stands for the base"
            )
            same = same_as(start, quantities, score.floor)
        if same is not None:
            yield from _as_given(same, score, words, start.free, exact)
    if quantities.causality not in ("force to motion", "unknown"):
        return
    known = quantities.output in MOTIONS
    split = modes(start, quantities.output if known else "position", identified)
    seen = (mode for mode in split if is_seen_moving(mode))
    for mode in itertools.islice(seen, TRIED):
        block = mode.chain[0]
        assert isinstance(block, Mechanism)  # noqa: S101  (for the type checker)
        words = (
            f"the base's mode at {frequency_of(block):.3g} Hz is a mechanism of its own"
        )
        if identified:
            best = fitted(mode, score)
            yield Host(best.state, best, words)
        else:
            yield from _as_given(mode, score, words, start.free, exact)


def _of_stores(start: ModelState, identified: bool, score: Score) -> Iterator[Host]:
    """Give one store and two in series, fitted to the records.

    Beside a given base that is no store already those that simulate the same, and, in
    place of a linear base of few real poles, those that do not: it may fall below the
    bottom of a tank. A bent outflow has another rate than a linear one, so their
    numbers are fitted, and that counts as a further effect.
    """
    if not (identified or may_be_stores(start)):
        return
    noise = float(np.sqrt(score.floor))
    for count, words in STORES.items():
        begun = stores(start.records, start.hold, noise, count)
        best = best_host(begun, score)
        if best is None or not all_are_seen_filling(best.state):
            continue
        words, alone, charge = f"{words} in place of the base", best.state, 0.0
        if not identified:
            same, charge = stores_like(start, count), FURTHER
            words += ", fitted to the records"
            if same is None:
                words += ", as none simulates the same"
            else:
                alone = same
        yield Host(alone, best, words, charge=charge)
        for other in in_other_order(best.state):
            yield Host(alone, best, words, other, charge)


def may_be_stores(start: ModelState) -> bool:
    """Tell whether a base is linear, with no more poles than two stores, all real."""
    poles = [
        np.roots(block.denominator)
        for block in start.chain
        if isinstance(block, TransferFunction)
    ]
    linear = all(isinstance(block, TransferFunction | Gain) for block in start.chain)
    few = len(poles) == 1 and 1 <= len(poles[0]) <= len(STORES)
    return linear and few and bool(np.isreal(poles[0]).all())


def stores_like(start: ModelState, count: int) -> ModelState | None:
    """Give stores in series that simulate what a given base does, if any do."""
    simulated = as_simulated(start)
    sample = ScoredSamples.of(simulated)
    score = Score.plain(sample, np.finfo(float).tiny)
    best = _likeliest(stores(simulated, start.hold, np.inf, count), score)
    if best is None or _missed(best) > _most_missed(start) * len(sample):
        return None
    return replace(best.state, records=start.records, sample=start.sample).settled()


def _as_given(
    state: ModelState, score: Score, words: str, free: tuple[Free, ...], exact: bool
) -> Iterator[Host]:
    """Give a host that does what a given base does, then the same fitted to records.

    The numbers of a given base are known, unless it says that some are free. That known
    ones are wrong all the same has to pay as a further effect does. What is only known
    about of the base, is only known about of the host.
    """
    about = replace(state, free=tuple(_about(state, x) for x in state.free))
    if free:
        known = all(item.given is not None for item in free)
        yield Host(state, fitted_to_the_end(about if known else state, score), words)
        return
    held = replace(state, free=())
    yield Host(held, fitted(held, score), f"{words}, its numbers as they are")
    if not exact:
        words = f"{words}, its numbers fitted to the records"
        yield Host(state, fitted_to_the_end(about, score), words, charge=FURTHER)


def _about(state: ModelState, free: Free) -> Free:
    """Give a number with what it may be off; one that is counted from a zero as is."""
    value = state.value(free)
    if free.parameter in ZEROS or value == 0.0:
        return free
    return free._replace(tolerance=ABOUT * abs(value), given=value)


def best_host(states: Iterable[ModelState], score: Score) -> Fitted | None:
    """Fit linear hosts, the likely ones to the end; give the one that scores least.

    What it gives as its output may also have a share of the next derivative (a zero).
    """
    best = _likeliest(states, score)
    if best is None:
        return None
    return min(best, _with_zero(best, score), key=lambda item: item.score)


def _likeliest(states: Iterable[ModelState], score: Score) -> Fitted | None:
    """Fit hosts a little, and the best of them to the end; None without any."""
    quick = [fitted(state, score, QUICK) for state in states]
    if not quick:
        return None
    return fitted(min(quick, key=lambda item: item.score).state, score)


def _with_zero(best: Fitted, score: Score) -> Fitted:
    """Fit a host whose output also has a share of the next derivative."""
    block, free = best.state.chain[0], best.state.free
    if not (isinstance(block, Mechanism) and block.output != "force"):
        return best
    return fitted(replace(best.state, free=(*free, Free(0, "blend"))), score)


def _loose(state: ModelState, score: Score, words: str) -> Iterator[Host]:
    """Give a mass without a spring, where another mass was fitted to its acceleration.

    A loose mass under a drag or a friction looks like one on a soft spring whose output
    has a share of the velocity: a force begins far from itself there. It comes last, as
    a friction that gives way before it slides is a spring to it.
    """
    block = state.chain[0]
    if not (isinstance(block, Mechanism) and block.output == "acceleration"):
        return
    for begun in free_masses(state.records, block.output, state.hold):
        alone = fitted(begun, score)
        yield Host(alone.state, alone, words)


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
        yield Host(best.state, best, words)


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
    return start.rearranged(start.chain[1:], moved).settled()


def _in_front(delay: Block, start: ModelState, state: ModelState) -> ModelState:
    """Give a model of such records on those of a base, with the timing of its input."""
    moved = {k: k + 1 for k in range(len(state.chain))}
    behind = state.rearranged((delay, *state.chain), moved)
    return replace(behind, records=start.records).settled()


def own_mechanism(start: ModelState) -> ModelState | None:
    """Give a base that holds a mechanism itself, with the numbers of that free.

    What drives the mechanism has no number of its own: it would be one of mass, damping
    and stiffness together.
    """
    places = host_places(start.chain)
    if len(places) != 1:
        return None
    if start.free:
        return start
    (place,) = places
    block = start.chain[place]
    names = NUMBERS if isinstance(block, Impedance) else NUMBERS[:-1]
    free = tuple(Free(place, x) for x in names if getattr(block, x) != 0.0)
    return replace(start, free=free)


def is_seen_moving(state: ModelState) -> bool:
    """Tell whether a host's motion is slow enough for its records to show it.

    Of a mass whose poles both lie beyond the highest frequency of the samples only the
    static gain is seen. A force inside is then a static curve, which a chain has.
    """
    block = state.chain[0]
    if not isinstance(block, Mechanism):
        return True
    poles = np.roots([block.mass, block.damping, block.stiffness])
    step = min(record.dt for record in state.records)
    return bool(np.min(np.abs(poles)) < np.pi / step)


def all_are_seen_filling(state: ModelState) -> bool:
    """Tell whether each of linear stores is slow enough for its records to show it.

    One that fills within a sampling interval does nothing; a law inside of it would be
    searched without end.
    """
    step = min(record.dt for record in state.records)
    rates = [block.rate for block in state.chain if isinstance(block, Store)]
    return max(rates) < np.pi / step


def of_many_modes(start: ModelState) -> bool:
    """Tell whether a base has more poles than a force can have bought it.

    Friction in one coordinate buys a linear model an order or two, not further modes
    that folds ask for.
    """
    return any(
        isinstance(block, TransferFunction) and len(block.denominator) > HIGHEST + 1
        for block in start.chain
    )


def same_as(
    start: ModelState, quantities: Quantities, floor: float
) -> ModelState | None:
    """Give a model of one coordinate that simulates what a given base does.

    It may differ by no more of the gap than two models that do the same. A zero and an
    offset are its own only where noise of that power does not hide what they do. Of a
    base that a gain and an offset do as well there is none: nothing moves in it.
    """
    simulated, most = as_simulated(start), _most_missed(start)
    u, wanted = (start.sample.take(x) for x in ([r.u for r in simulated], start.exact))
    static = np.column_stack([u, np.ones(len(u))])
    moves = wanted - static @ solved(static, wanted)
    if np.mean(moves**2) < most:
        return None
    unseen = min(AS_GOOD * floor, most)
    shown = [float(np.sum(moves[part] ** 2)) for part in start.sample.slices]
    one = _ByContent((simulated[int(np.argmax(shown))],))
    every, count = _ByContent(simulated), len(ScoredSamples.of(simulated))
    about = quantities, start.hold
    for with_zero, enough in ((False, unseen), (True, most)):
        # What the best model of one record misses there, one of all records does too.
        alone = _coordinate_like(one, *about, with_zero)
        if len(simulated) > 1 and _missed(alone) > enough * count:
            continue
        best = _coordinate_like(every, *about, with_zero)
        if best is not None and _missed(best) <= enough * count:
            same = _without_offset(best, unseen * count)
            return replace(same, records=start.records, sample=start.sample).settled()
    return None


def as_simulated(start: ModelState) -> tuple[Record, ...]:
    """Give records whose output is what the base simulates."""
    return tuple(
        replace(record, y=y, simulated=None, interpolated=None)
        for record, y in zip(start.records, start.exact, strict=True)
    )


def _most_missed(start: ModelState) -> float:
    """Give the mean square by which two models differ that do the same."""
    return AS_GOOD * float(np.mean(start.residual**2))


def _without_offset(best: Fitted, allowed: float) -> ModelState:
    """Leave out the gain and the offset behind a model that does as well without."""
    state = best.state
    if not isinstance(state.chain[-1], Gain):
        return state
    last = len(state.chain) - 1
    plain = replace(
        state,
        chain=state.chain[:-1],
        free=tuple(free for free in state.free if free.block != last),
    ).settled()
    return plain if float(np.sum(plain.residual**2)) <= allowed else state


def _missed(found: Fitted | None) -> float:
    """Sum the squares of what a model misses."""
    return np.inf if found is None else float(np.sum(found.state.residual**2))


class _ByContent:
    """Records as a key: any others of the same content will do."""

    def __init__(self, records: tuple[Record, ...]) -> None:
        self.records, self.digest = records, records_digest(records)

    def __hash__(self) -> int:
        return hash(self.digest)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _ByContent) and self.digest == other.digest


@lru_cache(maxsize=4)
def _coordinate_like(
    simulated: _ByContent, quantities: Quantities, hold: Hold, with_zero: bool
) -> Fitted | None:
    """Fit a model of one coordinate to what a base simulates.

    That does not depend on what was measured: a second look, on records without their
    offsets, asks for the same one. Nothing of a simulation is noise.
    """
    records = simulated.records
    score = Score.plain(ScoredSamples.of(records), np.finfo(float).tiny)
    if with_zero:
        plain = _coordinate_like(simulated, quantities, hold, False)
        return None if plain is None else _with_zero(plain, score)
    return _likeliest(one_coordinate(records, quantities, hold), score)
