"""What may be put inside a host: the laws of all effects, and how the host moves."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.parameter import HUGE
from hystbench.blocks.store import Store
from hystbench.gap.effects import among
from hystbench.gap.effects.law import Changed, Law, Moved
from hystbench.gap.fitting.least_squares import (
    Fitted,
)
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.put_in import host_of
from hystbench.gap.inside.stores import how_it_fills

Laws = Mapping[str, Sequence[Law | Changed]]
"""What may be put into a host, by effect."""
Offer = Callable[[Fitted], Laws]
"""Gives what may be put into a fitted host."""


def laws_for(
    host: Fitted, turns: bool = False, offered: Iterable[str] | None = None
) -> Laws:
    """Give what may be put into a host.

    Parameters
    ----------
    host : Fitted
        With or without effects inside already.
    turns : bool
        Whether its coordinate is an angle.
    offered : iterable of str, optional
        Effects that may be named; all by default.
    """
    every: dict[str, tuple[Law | Changed, ...]]
    if of_stores(host):
        filled = how_it_fills(host.state)
        every = {name: tuple(x.stored(filled)) for name, x in among(offered).items()}
    else:
        moved = how_it_moves(host.state, turns)
        every = {
            name: tuple(x.in_mechanism(moved)) for name, x in among(offered).items()
        }
    return {name: own for name, own in every.items() if own}


def of_stores(item: Fitted) -> bool:
    """Tell whether a model is of stores: all their laws are tried with each other.

    They are few, and the root of the level, which may be worse than a linear outflow
    alone, may be better than any other law with an overflow.
    """
    return any(isinstance(block, Store) for block in item.state.chain)


def how_it_moves(state: ModelState, turns: bool) -> Moved:
    """Look how far, how fast and by what force a host moves on its records."""
    place = host_of(state)
    host: Any = state.chain[place]
    reach = speed = force = 0.0
    for record, z in zip(state.records, state.simulation.driving(place), strict=True):
        motion = host.motion(z, record.dt, ())
        q = motion.position
        reach = max(reach, float(np.ptp(q)) / 2)
        speed = max(speed, float(np.max(np.abs(motion.velocity))))
        driving = record.y if host.name == "impedance" else z
        force = max(force, float(np.max(np.abs(driving - np.mean(driving)))))
    tiny = 1.0 / HUGE
    step = min(record.dt for record in state.records)
    given = [record.u for record in state.records]
    shown = state.simulation.output
    anywhere = isinstance(host, Mechanism) and host.stiffness == 0.0
    return Moved(
        max(reach, tiny),
        max(speed, tiny),
        max(force, tiny),
        step,
        turns,
        anywhere,
        host.stiffness,
        *(max(float(np.max(np.abs(x))) for x in signals) for signals in (given, shown)),
    )
