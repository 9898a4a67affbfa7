"""Looking again at the effects that were added, now that others are there."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from hystbench.gap.effects import among, effects
from hystbench.gap.fitting.cross_validation import gain_on_folds
from hystbench.gap.fitting.edit_chain import last_to, removable, without_effect
from hystbench.gap.fitting.model_score import make_score, score_of
from hystbench.gap.fitting.refit import finished
from hystbench.gap.fitting.score import Score
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
    anew: tuple[ModelState, int, SecondLook] | None = None
    for number, item in enumerate(state.added):
        if item.effect == SHAPE or not removable(state, number):
            continue
        place = _judged_anew(state, number, rounds, floor, rivals)
        if place.rival is not None:
            say(f"{item.effect} gives way to {place.look.taken}")
            return last_to(place.rival, number), (*looks, place.look)
        if anew is None and (better := place.in_another_form()):
            form, look = better
            anew = last_to(form, number), len(looks), look
        looks.append(place.look)
    if anew is not None:
        state, which, look = anew
        looks[which] = look
        say(f"{look.instead_of} is fitted anew")
    return state, tuple(looks)


class JudgedPlace(NamedTuple):
    """An effect and its rivals, all judged in its place."""

    ranking: tuple[Candidate, ...]
    own: Candidate | None
    """The effect in that ranking, if it could be judged again."""
    now: float
    """What the model scores as it is."""
    score: Score
    look: SecondLook
    """What is told of it, with the model as it is unless a rival takes the place."""
    rival: ModelState | None
    """The model in which a rival takes the place, if one does."""

    def in_another_form(self) -> tuple[ModelState, SecondLook] | None:
        """Give the effect as it was judged again, if that scores clearly better."""
        own, enough = self.own, self.now - SCALE
        if own is None or own.state is None or own.score >= enough:
            return None
        state, value = finished(own.state, self.score)
        if value >= enough:
            return None
        ranking = _with(self.ranking, own, own.form, value, state)
        return state, replace(self.look, ranking=ranking)


def _judged_anew(
    state: ModelState,
    number: int,
    rounds: Sequence[Round],
    floor: Floor,
    rivals: Collection[str],
) -> JudgedPlace:
    """Judge an effect and its rivals in its place; tell whether it gives way."""
    item, short = state.added[number], without_effect(state, number)
    # Other forms of the effect itself would do for a rival what the rival does not.
    score = make_score(short, floor)
    as_is, now = finished(state, score)
    near = rivals or _near(item.effect, rounds)
    is_itself = bool(rivals) or _is_itself(state, item, floor)
    if item.is_of_many_numbers or not is_itself:
        near = among(state.offered)
    have = tuple(other.effect for other in short.added)
    known = list(among({item.effect, *near} - set(have)).values())
    ranking = rank(short, score, known, folds=False)
    own = next((x for x in ranking if x.effect == item.effect and x.state), None)
    best, forms = ranking[0], [(now, state.freedom)]
    if own is not None and own.state is not None:
        forms.append((own.score, own.state.freedom))
    if best.state is not None and best.effect != item.effect:
        # If it lost itself, any rival wins. One of fewer numbers only has to score
        # better.
        least = min(value for value, _ in forms) if is_itself else np.inf
        fewer = best.state.freedom < min(numbers for _, numbers in forms)
        if best.score < (least if fewer else least - SCALE):
            on_folds = gain_on_folds(short, best.state, score)
            ranking = (replace(best, gain_on_folds=on_folds), *ranking[1:])
            if on_folds > PAYS:
                look = SecondLook(item.effect, have, ranking, best.effect)
                return JudgedPlace(ranking, own, now, score, look, best.state)
    shown = ranking if own is None else _with(ranking, own, item.form, now, as_is)
    look = SecondLook(item.effect, have, shown, None if own is None else own.effect)
    return JudgedPlace(ranking, own, now, score, look, None)


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
