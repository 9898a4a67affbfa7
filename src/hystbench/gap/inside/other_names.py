"""The same curve before or behind what has effects inside, under another name.

A material that nears a limit and a sensor that does are one curve behind a mass. It is
fitted by one of the two names, so that the other is put beside it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from hystbench.gap.effects.law import Law
from hystbench.gap.fitting.least_squares import Fitted
from hystbench.gap.inside.choose import best_of_each
from hystbench.gap.inside.insert_law import Offer


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
        free = {x.parameter for x in state.free if x.block == place}
        for name, laws in offered.items():
            forms = [
                law.form
                for law in laws
                if isinstance(law, Law)
                and law.place == added.place
                and type(law.block) is type(state.chain[place])
                and {*law.free} == free
            ]
            if not forms or name in best.effects:
                continue
            one = added._replace(effect=name, form=forms[0])
            renamed = (*state.added[:number], one, *state.added[number + 1 :])
            every.append(Fitted(replace(state, added=renamed), best.score))
    return best_of_each(every)
