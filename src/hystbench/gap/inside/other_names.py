"""The same curve before or behind what has effects inside, under another name.

A material that nears a limit and a sensor that does are one curve behind a mass. It is
fitted by one of the two names; what was found gets the other put beside it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from hystbench.blocks.base import Block
from hystbench.gap.effects import effects
from hystbench.gap.effects.law import Changed, Law
from hystbench.gap.fitting.least_squares import Fitted
from hystbench.gap.inside.choose import best_of_each
from hystbench.gap.inside.insert_law import Laws, Offer

Curve = tuple[str, type[Block], frozenset[str]]
"""Place, block and fitted numbers: what makes two laws one curve."""


def of_one_name(laws: Laws) -> Laws:
    """Leave out curves behind the host that a sensor's effect offers as well.

    Two names for one curve would take two places of the few that go on. Behind a mass
    stands a sensor rather than a material.
    """
    known = effects()
    sensors = {name for name in laws if known[name].place == "sensor"}
    read = {_curve(law) for name in sensors for law in laws[name]}
    read = {curve for curve in read if curve is not None and curve[0] == "behind"}
    kept = {
        name: own
        if name in sensors
        else tuple(law for law in own if _curve(law) not in read)
        for name, own in laws.items()
    }
    return {name: own for name, own in kept.items() if own}


def with_other_names(
    best: Fitted, found: Sequence[Fitted], offer: Offer
) -> list[Fitted]:
    """Add a hypothesis by the names of other effects that offer the same curves.

    Parameters
    ----------
    best : Fitted
    found : sequence of Fitted
        All that were tried; the host alone first.
    offer : callable
        Gives what may be put in.

    Returns
    -------
    list of Fitted
        Of each set of effects the best.
    """
    every, state, offered = list(found), best.state, offer(found[0])
    for number, added in enumerate(state.added):
        if added.place == "inside" or len(added.blocks) != 1:
            continue
        (place,) = added.blocks
        free = (x.parameter for x in state.free if x.block == place)
        curve = _curve_of(added.place, state.chain[place], free)
        for name, laws in offered.items():
            forms = [law.form for law in laws if _curve(law) == curve]
            if not forms or name in best.effects:
                continue
            one = added._replace(effect=name, form=forms[0])
            renamed = (*state.added[:number], one, *state.added[number + 1 :])
            every.append(Fitted(replace(state, added=renamed), best.score))
    return best_of_each(every)


def _curve(law: Law | Changed) -> Curve | None:
    """Give the curve that a law is; none where it changes a host's own number."""
    return _curve_of(law.place, law.block, law.free) if isinstance(law, Law) else None


def _curve_of(place: str, block: Block, free: Iterable[str]) -> Curve:
    return place, type(block), frozenset(free)
