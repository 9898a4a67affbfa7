"""Laws inside a host: which of all effects may be put there, and where a fit begins."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from hystbench.blocks.attached_mass import AttachedMass
from hystbench.blocks.base import Block
from hystbench.blocks.force import Force, against
from hystbench.blocks.impedance import NUMBERS, Impedance
from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.other_modes import OtherModes
from hystbench.blocks.parameter import HUGE
from hystbench.blocks.store import Store
from hystbench.gap.effects import among
from hystbench.gap.effects.law import Changed, Filled, Law, Moved, Passed
from hystbench.gap.fitting.least_squares import Fitted
from hystbench.gap.fitting.state import Added, Free, ModelState
from hystbench.record import Record

REMAINS = 0.05
"""Of a spring or a damper, at least, where a force begins that does its work."""

LINEAR = NUMBERS[:-1]
"""Numbers of the linear part of a mechanism."""

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
    passed, known = Passed(given, shown, *times), among(offered)
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
    linear = tuple(x for x in state.chain[place:] if isinstance(x, AttachedMass))
    reach = speed = force = 0.0
    for record, z in zip(state.records, state.simulation.driving(place), strict=True):
        motion = host.motion(z, record.dt, linear)
        q = motion.position
        reach = max(reach, float(np.ptp(q)) / 2)
        speed = max(speed, float(np.max(np.abs(motion.velocity))))
        driving = record.y if host.name == "impedance" else z
        force = max(force, float(np.max(np.abs(driving - np.mean(driving)))))
    tiny = 1.0 / HUGE
    anywhere = isinstance(host, Mechanism) and host.stiffness == 0.0
    return Moved(
        max(reach, tiny),
        max(speed, tiny),
        max(force, tiny),
        turns,
        anywhere,
        host.stiffness,
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
    last one.
    """
    base: list[Any] = list(state.chain)
    place = 0 if law.place == "before" else len(base)
    if law.place == "inside":
        host = host_of(state)
        place = host + 1
        if law.stands_for:
            left = (1.0 - law.stands_for) * base[host].stiffness
            spring = _if_free(state, host, "stiffness", left)
            base[host] = replace(base[host], stiffness=spring)
    chain = (*base[:place], law.block, *base[place:])

    state = state.rearranged(chain, {k: k + (k >= place) for k in range(len(base))})
    free = list(state.free)
    for name in law.free:
        low, high = law.ranges.get(name, (-np.inf, np.inf))
        free.append(Free(place, name, low=low, high=high))
    values: dict[str, Any] = {name: getattr(law.block, name) for name in law.free}
    item = Added(effect, law.place, law.form, (place,), values, float(len(law.free)))
    return replace(state, free=tuple(free), added=(*state.added, item))


def with_changed(state: ModelState, effect: str, changed: Changed) -> ModelState:
    """Give stores with other numbers, some of them free as well.

    The tolerance of such a number is dropped.
    """
    chain = list(state.chain)
    old = {
        f"{place}.{name}": float(getattr(chain[place], name))
        for place, values in changed.values.items()
        for name in values
    }
    for place, values in changed.values.items():
        chain[place] = replace(chain[place], **values)
    places = tuple(changed.values)
    was_free = tuple(x for x in state.free if f"{x.block}.{x.parameter}" in old)
    free = tuple(
        Free(x.block, x.parameter) if x in was_free and x.given is not None else x
        for x in state.free
    )
    more = tuple(x for x in (Free(*own) for own in changed.free) if x not in free)
    charge = max(float(len(more)), 1.0)
    item = Added(effect, "inside", changed.form, places, old, charge, was_free=was_free)
    return replace(
        state, chain=tuple(chain), free=(*free, *more), added=(*state.added, item)
    )


def evened(state: ModelState) -> ModelState:
    """Take out of a mass's spring and damper what a force put in last does on average.

    Along the way that the host goes without the force: the spring and the damper that
    are nearest to the force there, in least squares (statistical linearization [1]_).
    So the mode that the force is put into stays where it was. A host that is known
    stays as it is.

    References
    ----------
    .. [1] J. B. Roberts, P. D. Spanos, Random Vibration and Statistical Linearization,
       Wiley, 1990.
    """
    (place,) = state.added[-1].blocks
    law, chain = state.chain[place], list(state.chain)
    number = host_of(state)
    host = chain[number]
    if not isinstance(host, Mechanism):
        return state
    if place < number:
        known = any(np.isfinite(x.low) for x in state.free if x.block == number)
        # A gain does what a mass, a damper and a spring do together.
        known = known or not _any_is_free(state, number, "gain", "mass")
        return state if known else _as_strong(state, place)
    loose = _any_is_free(state, number, "stiffness", "damping")
    if not (isinstance(law, Force) and loose):
        return state
    own = chain[number + 1 :]
    others = tuple(x for x in own if isinstance(x, Force) and x is not law)
    square, product = np.zeros((3, 3)), np.zeros(3)
    for record, z in zip(state.records, state.simulation.driving(number), strict=True):
        way = host.motion(z, record.dt, others)
        q, v = (np.ascontiguousarray(x) for x in (way.position, way.velocity))
        place_counts = q if host.stiffness else np.zeros(len(q))
        columns = np.column_stack([place_counts, v, np.ones(len(q))])
        alike = 1.0 / max(float(np.sum(v**2)), 1.0 / HUGE)  # as records are weighed
        square += alike * columns.T @ columns
        product += alike * columns.T @ against((law,), q, v, record.dt)
    sizes = np.sqrt(np.maximum(np.diag(square), 1.0 / HUGE))
    if not (np.all(np.isfinite(square)) and np.all(np.isfinite(product))):
        return state
    scaled = square / np.outer(sizes, sizes)
    spring, damper, _ = np.linalg.lstsq(scaled, product / sizes, rcond=1e-9)[0] / sizes
    if max(abs(spring), abs(damper)) > HUGE:
        return state  # the host all but runs away
    stiffness = max(host.stiffness - spring, REMAINS * host.stiffness)
    damping = max(host.damping - damper, REMAINS * host.damping)
    chain[number] = replace(
        host,
        stiffness=_if_free(state, number, "stiffness", stiffness),
        damping=_if_free(state, number, "damping", damping),
    )
    return state.with_chain(tuple(chain))


def _as_strong(state: ModelState, place: int) -> ModelState:
    """Let a mass, and what is beside it, be driven as strongly as without the curve."""
    pairs = zip(state.simulation.at(place), state.simulation.at(place + 1), strict=True)
    powers = np.array([[np.var(one), np.var(other)] for one, other in pairs])
    before, behind = np.sum(powers / np.maximum(powers[:, :1], 1.0 / HUGE), axis=0)
    times = float(np.sqrt(behind / before)) if before > 0 else 1.0
    if not (np.isfinite(times) and times > 0):
        return state
    chain = list(state.chain)
    for k, block in enumerate(chain):
        if isinstance(block, Mechanism):
            chain[k] = replace(block, gain=block.gain / times)
        elif isinstance(block, OtherModes):
            up = tuple(x / times for x in block.numerator)
            chain[k] = replace(block, numerator=up)
    return state.with_chain(tuple(chain))


def _unknown(state: ModelState, place: int) -> dict[str, Free]:
    """Give the numbers of a block that may be anything, as nobody knows them."""
    own = (free for free in state.free if free.block == place)
    return {free.parameter: free for free in own if free.given is None}


def _any_is_free(state: ModelState, place: int, *names: str) -> bool:
    """Tell whether some number of a block may be anything."""
    return not _unknown(state, place).keys().isdisjoint(names)


def _if_free(state: ModelState, place: int, name: str, value: float) -> float:
    """Give a number of a block a value in its range; as it is if it is known."""
    free = _unknown(state, place).get(name)
    if free is None:
        return float(getattr(state.chain[place], name))
    return float(np.clip(value, free.low, free.high))


def host_of(state: ModelState) -> int:
    """Give the place of what forces are put inside of: the last host of the chain."""
    return host_places(state.chain)[-1]


def own_numbers(state: ModelState, place: int) -> tuple[Free, ...]:
    """Give the numbers that a host has itself as free ones.

    What drives a mechanism has none of its own: it would be one of mass, damping and
    stiffness together.
    """
    block = state.chain[place]
    names = NUMBERS if isinstance(block, Impedance) else LINEAR
    return tuple(Free(place, name) for name in names if getattr(block, name) != 0.0)


def host_places(chain: Sequence[Block]) -> list[int]:
    """Give the places of the blocks of a chain that forces may be put inside of."""
    hosts = (Mechanism, Impedance)
    return [k for k, block in enumerate(chain) if isinstance(block, hosts)]
