"""Looking again at the effects that were added, now that others are there."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from hystbench.gap.effects import among, effects
from hystbench.gap.fitting.cross_validation import gain_on_folds
from hystbench.gap.fitting.edit_chain import last_to, removable, without_effect
from hystbench.gap.fitting.model_score import make_score, score_of
from hystbench.gap.fitting.refit import finished
from hystbench.gap.fitting.state import Added, ModelState
from hystbench.gap.naming.rank import does_without_itself, rank
from hystbench.gap.naming.rounds import WIDER, Candidate, Round, SecondLook, in_order
from hystbench.gap.progress import Say
from hystbench.gap.records.floor import Floor
from hystbench.gap.thresholds import PAYS, SCALE, SHAPE

CLOSE = 0.6
"""A rival gains at least this share of the gain of the best of its round: clearly more
than half, as what gains less takes another part of the gap. A convention."""


def reconsidered(
    state: ModelState,
    rounds: Sequence[Round],
    floor: Floor,
    say: Say,
    rivals: Collection[str] = (),
) -> tuple[ModelState, tuple[SecondLook, ...]]:
    """Try the rivals of each effect in its place, now that others are there.

    The first effect was named while the others were missing: one like it may have
    looked better for that, or another form of it. A rival has to do better than both.
    A hysteresis that has no loop any more gives way to the best of all others: it is a
    curve. All others are rivals of an effect of many numbers as well: it does what they
    do.

    Parameters
    ----------
    state : ModelState
    rounds : sequence of Round
        Tell which effects came near one.
    floor : Floor
    say : callable
    rivals : collection of str
        Effects that are rivals of all; by default those that came near one.

    Returns
    -------
    state : ModelState
    looks : tuple of SecondLook
        At each effect in turn; the last one is that at which one gave way, if any did.
    """
    looks: list[SecondLook] = []
    better: tuple[int, ModelState, tuple[Candidate, ...]] | None = None
    for number, item in enumerate(state.added):
        if item.effect == SHAPE or not removable(state, number):
            continue
        short = without_effect(state, number)
        # Other forms of the effect itself would do for a rival what the rival does not.
        score = make_score(short, floor)
        as_is, now = finished(state, score)
        have = tuple(other.effect for other in short.added)
        near = rivals or _near(item.effect, rounds)
        is_itself = bool(rivals) or _is_itself(state, item, floor)
        if item.is_of_many_numbers or not is_itself:
            near = among(state.offered)
        known = list(among({item.effect, *near} - set(have)).values())
        ranking = rank(short, score, known, folds=False)
        best = ranking[0]
        own = next((x for x in ranking if x.effect == item.effect and x.state), None)
        least = now if own is None else min(now, own.score)
        least = least if is_itself else np.inf  # if it lost itself, any rival wins
        # A rival of fewer numbers need only score better.
        numbers = min(x.freedom for x in (state, own and own.state) if x)
        fewer = best.state is not None and best.state.freedom < numbers
        enough = least if fewer else least - SCALE
        if best.state and best.effect != item.effect and best.score < enough:
            on_folds = gain_on_folds(short, best.state, score)
            ranking = (replace(best, gain_on_folds=on_folds), *ranking[1:])
            if on_folds > PAYS:
                say(f"{item.effect} gives way to {best.effect}")
                looks.append(SecondLook(item.effect, have, ranking, best.effect))
                return last_to(best.state, number), tuple(looks)
        if own is None:
            looks.append(SecondLook(item.effect, have, ranking, None))
            continue
        if better is None and own.state and own.score < now - SCALE:
            anew, least = finished(own.state, score)
            if least < now - SCALE:
                anew = last_to(anew, number)
                better = len(looks), anew, _with(ranking, own, own.form, least, anew)
        shown = _with(ranking, own, item.form, now, as_is)
        looks.append(SecondLook(item.effect, have, shown, item.effect))
    if better is not None:
        place, state, ranking = better
        looks[place] = replace(looks[place], ranking=ranking)
        say(f"{looks[place].instead_of} is fitted anew")
    return state, tuple(looks)


def _is_itself(state: ModelState, item: Added, floor: Floor) -> bool:
    """Tell whether an effect has not lost what makes it that to a later one."""
    of_effect = effects()[item.effect]
    if of_effect.without_itself([state.chain[k] for k in item.blocks]) is None:
        return True  # most have nothing that they could lose, and need no score
    score = make_score(state, floor)
    return not does_without_itself(state, item, score_of(state, score), score)


def _with(
    ranking: Sequence[Candidate],
    own: Candidate,
    form: str,
    score: float,
    state: ModelState,
) -> tuple[Candidate, ...]:
    """Give a ranking in which an effect stands as a model has it."""
    gain = own.gain + own.score - score
    shown = replace(own, form=form, score=score, gain=gain, state=state)
    return tuple(in_order(shown if x is own else x for x in ranking))


def _near(effect: str, rounds: Sequence[Round]) -> set[str]:
    """Give the effects that came near one in the rounds.

    And those that were refitted in its round and lost their way: beside what came later
    they may not.
    """
    found = set()
    for one in rounds:
        best = one.ranking[0].gain
        near = {x.effect for x in one.ranking if x.gain > CLOSE * best}
        if effect in near:
            found |= near
        if effect == one.ranking[0].effect:
            found |= {x.effect for x in one.ranking if x.declined == WIDER} - {SHAPE}
    return found
