"""Laws inside a host: which of all effects may be put there, and where a fit begins."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from hystbench.blocks.attached_mass import AttachedMass
from hystbench.blocks.force import Force
from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.mechanism import Mechanism, slope_of
from hystbench.blocks.parameter import HUGE
from hystbench.blocks.store import Store
from hystbench.gap.effects import among
from hystbench.gap.effects.effect import goes_both_ways, start_of
from hystbench.gap.effects.law import Changed, Filled, Law, Moved, Passed
from hystbench.gap.fitting.edit_chain import rearranged
from hystbench.gap.fitting.least_squares import Fitted
from hystbench.gap.fitting.state import Added, Free, ModelState
from hystbench.gap.inside.average_force import (
    any_is_free,
    relieved,
    spring_of,
    without_spring,
)
from hystbench.gap.inside.host_places import host_of
from hystbench.gap.inside.joint import has_no_joint
from hystbench.record import Record

Laws = Mapping[str, Sequence[Law | Changed]]
"""What may be put into a host, by effect."""
Offer = Callable[[Fitted], Laws]
"""Gives what may be put into a fitted host."""


class Times(NamedTuple):
    """The shortest sampling interval, and the shortest lag that is an effect."""

    step: float
    shortest: float

    @classmethod
    def of(cls, records: Iterable[Record], identified: bool) -> Times:
        """Take them from records before any sample of them was left out."""
        step = min(record.dt for record in records)
        return cls(step, step if identified else step / 20)


def laws_for(
    host: Fitted,
    turns: str = "",
    offered: Iterable[str] | None = None,
    times: Times | None = None,
) -> Laws:
    """Give what may be put into a host.

    Parameters
    ----------
    host : Fitted
        With or without effects inside already.
    turns : str
        Unit of its coordinate where that is an angle: rad or deg.
    offered : iterable of str, optional
        Effects that may be named; all by default.
    times : Times, optional
        Of the host's own records by default, as of one that was identified from them.
    """
    times = Times.of(host.state.records, True) if times is None else times
    signals = [record.u for record in host.state.records], host.state.simulation.output
    given, shown = (max(float(np.max(np.abs(x))) for x in every) for every in signals)
    passed = Passed(given, shown, *times, goes_both_ways(signals[0]))
    known = among(offered)
    around = {name: tuple(effect.around(passed)) for name, effect in known.items()}
    own: dict[str, Iterator[Law | Changed]]
    if of_stores(host):
        filled = how_it_fills(host.state)
        own = {name: effect.stored(filled) for name, effect in known.items()}
        # A lag beside stores is one more store.
        around = {
            name: tuple(law for law in laws if not isinstance(law.block, LinearBlock))
            for name, laws in around.items()
        }
    elif has_no_joint(host.state.chain[host_of(host.state)]):
        own = {name: iter(()) for name in known}
    else:
        moved = how_it_moves(host.state, turns)
        own = {name: effect.in_mechanism(moved) for name, effect in known.items()}
    every = {name: (*own[name], *around[name]) for name in known}
    return {name: laws for name, laws in every.items() if laws}


def of_stores(item: Fitted) -> bool:
    """Tell whether a model is of stores: all their laws are tried with each other.

    They are few, and the root of the level, which may be worse than a linear outflow
    alone, may be better than any other law with an overflow.
    """
    return any(isinstance(block, Store) for block in item.state.chain)


def how_it_moves(state: ModelState, turns: str) -> Moved:
    """Look how far, how fast and by what force a host moves on its records."""
    place = host_of(state)
    host: Any = state.chain[place]
    inside = tuple(x for x in state.chain[place:] if isinstance(x, Force))
    linear = tuple(x for x in inside if isinstance(x, AttachedMass) or x.slope > 0.0)
    spring = spring_of(host) + slope_of(inside)
    reach = speed = force = 0.0
    for record, z in zip(state.records, state.simulation.driving(place), strict=True):
        motion = host.motion(z, record.dt, linear)
        q = motion.position
        reach = max(reach, float(np.ptp(q)) / 2)
        speed = max(speed, float(np.max(np.abs(motion.velocity))))
        driving = record.y if host.name == "impedance" else z
        force = max(force, float(np.max(np.abs(driving - np.mean(driving)))))
    tiny = 1.0 / HUGE
    known = not any_is_free(state, place, "stiffness")
    free = isinstance(host, Mechanism) and spring == 0.0
    # A window of a record begins at zero: where that lies is not told.
    whole = all(record.decay_s is None for record in state.records)
    seen = free and known and whole and host.output == "position"
    if seen:  # without what holds it, it would have gone far beyond
        shown = max(float(np.ptp(record.y)) / 2 for record in state.records)
        reach = min(reach, shown)
    return Moved(
        max(reach, tiny),
        max(speed, tiny),
        max(force, tiny),
        turns,
        free and not seen,
        spring,
        without_spring(state, place) is not state,
        known,
    )


def how_it_fills(state: ModelState) -> Filled:
    """Look how high the stores of a chain are filled on its records."""
    tops = []
    for k, block in enumerate(state.chain):
        if isinstance(block, Store):
            level = replace(block, output="level")
            signals = state.simulation.tail(k, [level])
            tops.append((k, block, max(float(z.max()) for z in signals)))
    measured = max(float(record.y.max()) for record in state.records)
    last = state.chain[-1]
    is_shown = isinstance(last, Store) and last.output == "level" and measured > 0
    known = all(free.given is not None for free in state.free)
    return Filled(tuple(tops), measured if is_shown else None, known)


def with_law(state: ModelState, effect: str, law: Law) -> ModelState:
    """Put a law into a chain, with its numbers free.

    A force goes behind the host, a filter before all or behind all. What a force stands
    for goes out of the host's spring, if that may change. Of several hosts it is the
    last one. A lag begins as the host does, unless that begins at rest.
    """
    base: list[Any] = list(state.chain)
    place, replaced = 0 if law.place == "before" else len(base), 0
    if law.place == "inside":
        host = host_of(state)
        place = host + 1
        if law.stands_for == 1.0:
            before, state = len(state.free), without_spring(state, host)
            replaced = before - len(state.free)
        elif law.stands_for:
            state = relieved(state, host, law.stands_for * spring_of(base[host]))
        base = list(state.chain)
    block: Any = law.block
    begun = start_of(base)
    if isinstance(block, LinearBlock) and begun != "rest":
        block = replace(block, start=begun)
    chain = (*base[:place], block, *base[place:])

    state = rearranged(state, chain, {k: k + (k >= place) for k in range(len(base))})
    free = list(state.free)
    for name in law.free:
        low, high = law.ranges.get(name, (-np.inf, np.inf))
        free.append(Free(place, name, low=low, high=high))
    values: dict[str, Any] = {name: getattr(law.block, name) for name in law.free}
    more = float(len(law.free) - replaced)
    item = Added(effect, law.place, law.form, (place,), values, more)
    return replace(state, free=tuple(free), added=(*state.added, item))


def with_changed(state: ModelState, effect: str, changed: Changed) -> ModelState:
    """Give stores with other numbers, some of them free as well.

    The tolerance of such a number is dropped.
    """
    old = {
        f"{place}.{name}": float(getattr(state.chain[place], name))
        for place, values in changed.values.items()
        for name in values
    }
    places = tuple(changed.values)
    was_free = tuple(x for x in state.free if f"{x.block}.{x.parameter}" in old)
    free = tuple(
        Free(x.block, x.parameter) if x in was_free and x.given is not None else x
        for x in state.free
    )
    more = []
    for own in changed.free:
        low, high = changed.ranges.get(own, (-np.inf, np.inf))
        more.append(Free(*own, low=low, high=high))
    more = [x for x in more if x not in free]
    charge = max(float(len(more)), 1.0)
    item = Added(effect, "inside", changed.form, places, old, charge, was_free=was_free)
    state = replace(state, free=(*free, *more), added=(*state.added, item))
    return state.with_values(changed.values)
