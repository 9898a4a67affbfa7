"""Forces in a host of known numbers, found where those numbers are free."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from hystbench.blocks.mechanism import Mechanism
from hystbench.gap.fitting.edit_chain import without_effect
from hystbench.gap.fitting.least_squares import Fitted, fitted, fitted_to_the_end
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.choose import best_of_each, least
from hystbench.gap.inside.combine_forces import PAIRS, ForceSearch
from hystbench.gap.inside.host_places import LINEAR, host_of, own_numbers
from hystbench.gap.inside.insert_law import of_stores


def with_best_beside_free(
    found: Sequence[Fitted], forces: ForceSearch, beside_free: Sequence[Fitted] = ()
) -> list[Fitted]:
    """Add the forces and pairs that do best where the host's own numbers are free.

    Two forces that are missing each leave what a wrong spring and a wrong damper do.
    With the numbers known, a single force is then judged by how well it makes up for
    both, and the right two are not carried on. With the numbers free it is judged by
    its own shape. And an impact turns a motion so much that numbers which are off by
    little end in another minimum. What is best there is fitted beside the known
    numbers, from where these were found if they have a tolerance.

    Parameters
    ----------
    found : sequence of Fitted
        The host alone first, then with forces.
    forces : ForceSearch
    beside_free : sequence of Fitted
        What was found with those numbers free, if that was looked for.

    Returns
    -------
    list of Fitted
        Those given, the best single, the pairs, and each of their forces alone; of each
        set of effects the best.
    """
    host = found[0].state
    if of_stores(found[0]):
        return list(found)
    place, score = host_of(host), forces.score
    if not isinstance(host.chain[place], Mechanism) or not _known(host, place):
        return list(found)
    if not beside_free:
        others = (item for item in host.free if item.block != place)
        free = (*others, *own_numbers(host, place))
        begun = fitted(replace(host, free=free), score)
        forces.say(
            "inside: with its own numbers free, to see which forces belong together"
        )
        beside_free = forces.together(forces.singles(begun), 2)
    likely = sorted(beside_free, key=lambda item: item.score)
    one, *_ = (item for item in likely if len(item.effects) < 2)
    pairs = [item for item in likely if len(item.effects) == 2]
    every = list(found)
    if one.effects:
        every.append(fitted_to_the_end(_beside_known(one.state, host), score))
    for pair in pairs[:PAIRS]:
        beside = fitted_to_the_end(_beside_known(pair.state, host), score)
        each = (without_effect(beside.state, k) for k in range(2))
        every += [beside, *(fitted_to_the_end(state, score) for state in each)]
    best, alone = least(every), found[0].score
    if best.effects:
        forces.say(f"inside: {' + '.join(best.effects)}: gain {alone - best.score:.1f}")
    return best_of_each(every)


def _known(state: ModelState, place: int) -> bool:
    """Tell whether the linear numbers of a host are known, exactly or about."""
    own = (x for x in state.free if x.block == place and x.parameter in LINEAR)
    return all(x.given is not None for x in own)


def _beside_known(state: ModelState, host: ModelState) -> ModelState:
    """Give a host of a model with forces its known numbers back, or about."""
    place, was = host_of(state), host_of(host)
    about = [x for x in host.free if x.block == was]
    found = state.chain[place]
    others = (x for x in state.free if x.block != place)
    own = tuple(x._replace(block=place) for x in about)
    known = replace(state, free=(*others, *own))
    known = known.with_blocks({place: host.chain[was]})
    moved = {
        k: float(getattr(found, free.parameter))
        for k, free in enumerate(known.free)
        if free in own
    }
    return known.at(moved)
