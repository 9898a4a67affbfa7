"""The ladder of the gap: the models on the way from the base to the last effect."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

from hystbench.gap.effects import effects
from hystbench.gap.fitting.on_records import compared_records
from hystbench.gap.fitting.own_values import NONE, OwnValues
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.locate import Contribution
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.records.black_box import BlackBox
from hystbench.gap.records.floor import Floor
from hystbench.model import Model

BASE = "base"
RETUNED = "base re-tuned"


class Rung(NamedTuple):
    """A model on the way, and what was done to reach it."""

    name: str
    state: ModelState


@dataclass(frozen=True)
class FitResult:
    """What the fit records fix; hold-out records are compared with it."""

    base: Model
    state: ModelState
    """The model with all effects that were added, on the fit records."""
    floor: Floor
    black_box: BlackBox
    """Fitted to what the base leaves on the fit records."""
    rungs: tuple[Rung, ...]
    """The models on the way from the base to the last effect."""
    own: OwnValues = NONE
    """What some records have of their own: a hold-out record may have the same."""


def rungs(start: ModelState, named: Named) -> tuple[Rung, ...]:
    """Give the base, the base re-tuned where it is free, then effect by effect.

    Each rung is the model as it was fitted with the effects that it has: the last one
    without an effect would be no model that anybody fitted. A model with an effect that
    went out again is no rung, nor one that lacks what the rung before it has: so what a
    rung is called is all that it has more.

    Parameters
    ----------
    start : ModelState
        The base as it was given.
    named : Named
    """
    found = [Rung(BASE, start)]
    states = [one.before for one in named.rounds]
    if start.free:
        found.append(Rung(RETUNED, states[0] if states else named.state))
    last: set[str] = set()
    kept = {item.effect for item in named.state.added}
    for state in (*states[1:], named.state) if named.state.added else ():
        names = [item.effect for item in state.added]
        if last < set(names) <= kept:
            new = [name for name in names if name not in last]
            found.append(Rung(" + ".join(new), state))
            last = set(names)
    # The last one was fitted once more, to the end.
    return (*found[:-1], found[-1]._replace(state=named.state if found[1:] else start))


def contributions(ladder: Sequence[Rung]) -> list[Contribution]:
    """Give what each named effect adds to the output of the rung before it."""
    outputs = [compared_records(rung.state) for rung in ladder]
    retuned = any(rung.name == RETUNED for rung in ladder)
    found = []
    for (old, new), (before, after) in zip(
        pairwise(ladder), pairwise(outputs), strict=True
    ):
        added = tuple(
            b.simulated - a.simulated for a, b in zip(before, after, strict=True)
        )
        known = {item.effect for item in old.state.added}
        found += [
            Contribution(
                item.effect,
                effects()[item.effect].shows,
                added,
                item.charge,
                to_a_retuned_base=retuned,
            )
            for item in new.state.added
            if item.effect not in known
        ]
    return found
