"""The ladder of the gap: the models on the way from the base to the last effect."""

from __future__ import annotations

from typing import NamedTuple

from hystbench.gap.name import Named
from hystbench.gap.state import State

BASE = "base"
RETUNED = "base re-tuned"


class Rung(NamedTuple):
    """A model on the way, and what was done to reach it."""

    name: str
    state: State


def rungs(start: State, named: Named) -> tuple[Rung, ...]:
    """Give the base, the base re-tuned where it is free, then effect by effect.

    Each rung is the model as it was fitted with the effects that it has: the last one
    without an effect would be no model that anybody fitted. An effect that went out
    again has no rung.

    Parameters
    ----------
    start : State
        The base as it was given.
    named : Named
    """
    found = [Rung(BASE, start)]
    states = [one.before for one in named.rounds]
    if start.free:
        found.append(Rung(RETUNED, states[0] if states else named.state))
    last: list[str] = []
    kept = {item.effect for item in named.state.added}
    for state in (*states[1:], named.state) if named.state.added else ():
        names = [item.effect for item in state.added]
        new = [name for name in names if name in kept and name not in last]
        if new:
            found.append(Rung(" + ".join(new), state))
        last = names
    # The last one was fitted once more, to the end.
    return (*found[:-1], found[-1]._replace(state=named.state if found[1:] else start))
