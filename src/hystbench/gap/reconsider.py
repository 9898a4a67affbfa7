"""Looking again at the effects that were added, now that others are there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from hystbench.gap.change import removable, without_effect
from hystbench.gap.effects import effects
from hystbench.gap.fit import refit
from hystbench.gap.rank import Look, Round, in_order, make_score, rank
from hystbench.gap.say import Say
from hystbench.gap.state import State
from hystbench.gap.thresholds import CLOSE, SHAPE, SWAP


def reconsidered(
    state: State,
    rounds: Sequence[Round],
    floor_rms: float,
    say: Say,
    every: bool = False,
) -> tuple[State, tuple[Look, ...]]:
    """Try the rivals of each effect in its place, now that others are there.

    The first effect was named while the others were missing: one like it may have
    looked better for that.

    Parameters
    ----------
    state : State
    rounds : sequence of Round
        Tell which effects came near one.
    floor_rms : float
    say : callable
    every : bool
        Whether all effects are rivals, not only those that came near.

    Returns
    -------
    state : State
    looks : tuple of Look
        At each effect in turn; the last one is that at which one gave way, if any did.
    """
    looks: list[Look] = []
    for number, item in enumerate(state.added):
        if item.effect == SHAPE or not removable(state, number):
            continue
        short = without_effect(state, number)
        # Other forms of the effect itself would do for a rival what the rival does not.
        score = make_score(short, floor_rms)
        again, now = refit(state, score)
        have = tuple(other.effect for other in short.added)
        names = set(effects()) if every else _rivals(item.effect, rounds)
        known = [effects()[name] for name in sorted(names - set(have))]
        ranking = rank(short, score, known)
        best = ranking[0]
        other = best.state is not None and best.effect != item.effect
        if other and best.score < now - SWAP:
            gain = now - best.score
            say(f"{item.effect} gives way to {best.effect}: {gain:.1f}")
            looks.append(Look(item.effect, have, ranking, best.effect))
            return best.state or state, tuple(looks)
        own = next((x for x in ranking if x.effect == item.effect), None)
        kept = own is not None and own.state is not None
        if own is not None and kept:
            # A search from anew may end worse than the model that is there.
            as_is = replace(
                own, score=now, gain=own.gain + own.score - now, state=again
            )
            ranking = tuple(
                in_order(as_is if x is own and now < own.score else x for x in ranking)
            )
        looks.append(Look(item.effect, have, ranking, item.effect if kept else None))
    return state, tuple(looks)


def _rivals(effect: str, rounds: Sequence[Round]) -> set[str]:
    found = {effect}
    for one in rounds:
        best = one.ranking[0].gain
        near = {x.effect for x in one.ranking if x.gain > CLOSE * best}
        if effect in near:
            found |= near
    return found
