"""One round: every effect beside a model, tried and ranked."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from hystbench.errors import InputError
from hystbench.gap.change import at_end
from hystbench.gap.effects import effects
from hystbench.gap.effects.base import Effect
from hystbench.gap.fit import score_of
from hystbench.gap.held_back import cross_validated
from hystbench.gap.reshape import orthonormal
from hystbench.gap.score import Score
from hystbench.gap.search import Trial
from hystbench.gap.state import State
from hystbench.gap.thresholds import (
    EXACT,
    FINALISTS,
    NEAR,
    PAYS,
    SHAPE,
    STILL,
    TIE,
    WORSE,
)
from hystbench.gap.work import IN_PROCESS, Tried, Work


class Tested(NamedTuple):
    """A variant of an effect: where and how it was tried, and its score."""

    place: str
    form: str
    position: int | None
    """Of its first block in the chain; None for a signal beside it."""
    score: float


@dataclass(frozen=True)
class Candidate:
    """An effect as it did in one round.

    Parameters
    ----------
    effect, place, form : str
    score : float
        Of the model with it: of a finalist that pays as records held back tell it, of
        the others on all records.
    gain : float
        By how much it lowers the score.
    state : State, optional
        With the effect, jointly refitted; finalists have it.
    declined : str
        Why it could not be judged, if so.
    held_back : float, optional
        What a finalist that pays gains on records held back, without any charge.
    variants : tuple of Tested
        Every place and form of it that could be scored, best first.
    """

    effect: str
    place: str
    form: str = ""
    score: float = np.inf
    gain: float = 0.0
    state: State | None = None
    declined: str = ""
    held_back: float | None = None
    variants: tuple[Tested, ...] = ()


@dataclass(frozen=True)
class Look:
    """A second look: an effect and its rivals in its place, now that others are there.

    Parameters
    ----------
    instead_of : str
        The effect in whose place they were tried.
    beside : tuple of str
        The other effects, which stayed.
    ranking : tuple of Candidate
        Best first.
    taken : str, optional
        The effect that has the place by this ranking. None where the one that was
        there could not be judged again: it stays by the ranking that took it before.
    """

    instead_of: str
    beside: tuple[str, ...]
    ranking: tuple[Candidate, ...]
    taken: str | None


@dataclass(frozen=True)
class Round:
    """One round: the model before, every effect beside it, what was added.

    Parameters
    ----------
    before : State
    score : float
        Of the model before.
    ranking : tuple of Candidate
        Best first.
    taken : bool
        Whether the first of the ranking was added.
    looks : tuple of Look
        At the effects that were there when it was, in their order.
    """

    before: State
    score: float
    ranking: tuple[Candidate, ...]
    taken: bool
    looks: tuple[Look, ...] = ()


def reasons(rounds: Iterable[Round]) -> dict[str, tuple[Candidate, ...]]:
    """Give the last ranking by which each effect was taken, or kept.

    What scores better than a wrong shape that goes first is no rival of it: the shape
    is needed beside it.
    """
    found: dict[str, tuple[Candidate, ...]] = {}
    for one in rounds:
        first = one.ranking[0]
        if one.taken and first.effect == SHAPE:
            found[SHAPE] = tuple(x for x in one.ranking if x.score >= first.score)
        elif one.taken:
            found[first.effect] = one.ranking
        found |= {x.taken: x.ranking for x in one.looks if x.taken is not None}
    return found


def near(first: Candidate, ranking: Sequence[Candidate]) -> tuple[str, ...]:
    """Give the effects that score within the tie of one that was added."""
    return tuple(
        item.effect
        for item in ranking
        if item.effect != first.effect
        and item.state is not None
        and item.score < first.score + TIE
    )


def make_score(state: State, floor_rms: float, forms: bool = True) -> Score:
    """Give the score for a model: what could be wrong in its shape is spanned anew.

    Parameters
    ----------
    state : State
    floor_rms : float
    forms : bool
        Whether the added effects may be of another form too; not when their own
        numbers are to be found.
    """
    wrong = [state.reshapings] + ([state.other_forms] if forms else [])
    return Score(state.sample, orthonormal(np.hstack(wrong)), floor_rms**2)


def rank(
    state: State,
    score: Score,
    known: Sequence[Effect] | None = None,
    work: Work = IN_PROCESS,
) -> tuple[Candidate, ...]:
    """Try every effect beside a model, the likely ones to the end.

    Returns
    -------
    tuple of Candidate
        Finalists first, then the others, then those that declined.
    """
    known = tuple(effects().values()) if known is None else tuple(known)
    have = {item.effect for item in state.added}
    now = score_of(state, score)
    declined = [
        Candidate(effect.name, effect.place, declined="added already")
        for effect in known
        if effect.name in have
    ]
    others = [effect for effect in known if effect.name not in have]
    found: list[Tried] = []
    for effect in others:
        trials, why = work.tried(effect, state, score)
        found += trials
        if why:
            declined.append(Candidate(effect.name, effect.place, declined=why))
    if not found:
        return tuple(declined)
    best = min(trial.score for _, trial in found)
    reach = max(NEAR, (now - best) * STILL)
    refined = [
        work.fine(attempt, trial) if trial.score < best + reach else trial
        for attempt, trial in found
    ]
    refined.sort(key=lambda trial: trial.score)
    of_effect: dict[str, Trial] = {}
    tested: dict[str, list[Tested]] = {}
    for trial in refined:
        of_effect.setdefault(trial.variant.effect, trial)
        tested.setdefault(trial.variant.effect, []).append(_tested(trial))
    likely = [
        trial
        for number, trial in enumerate(of_effect.values())
        if number < FINALISTS
        or (trial.variant.effect == SHAPE and now - trial.score > PAYS)
    ]
    judged = [_judged(trial, state, score, now, work) for trial in likely]
    judged += [
        _candidate(trial, now)
        for trial in of_effect.values()
        if not any(trial is item for item in likely)
    ]
    judged = [replace(x, variants=tuple(tested[x.effect])) for x in judged]
    declined += [item for item in judged if item.declined]
    candidates = in_order(item for item in judged if not item.declined)
    candidates = [
        exactly(item, score, now, work)
        if place < EXACT and item.score < candidates[0].score + NEAR
        else item
        for place, item in enumerate(candidates)
    ]
    candidates = [held_back(item, state, score) for item in candidates]
    return (*in_order(candidates), *declined)


def in_order(candidates: Iterable[Candidate]) -> list[Candidate]:
    """Put finalists first, and what scores least first among them."""
    return sorted(candidates, key=lambda item: (item.state is None, item.score))


def _tested(trial: Trial) -> Tested:
    variant = trial.variant
    position = variant.start + variant.positions[0] if variant.positions else None
    return Tested(variant.place, variant.form, position, trial.score)


def _candidate(trial: Trial, now: float) -> Candidate:
    variant = trial.variant
    gain = now - trial.score
    return Candidate(variant.effect, variant.place, variant.form, trial.score, gain)


def _judged(
    trial: Trial, state: State, score: Score, now: float, work: Work
) -> Candidate:
    """Add an effect that gains anything, refit all together, and say what is wrong."""
    variant = trial.variant
    item = _candidate(trial, now)
    if item.gain <= 0:
        return item

    def declined(why: str) -> Candidate:
        return Candidate(variant.effect, variant.place, declined=why)

    try:
        after, value = work.added(state, trial, score)
    except InputError as error:
        return declined(f"fits best where {error}")
    end = at_end(after, variant)
    if end:
        return declined(f"fits best at the end of what it can be: {end}")
    power = state.power(score.floor)
    if after.share(state, score.floor, power) < -WORSE:
        return declined("makes the gap wider")
    return replace(item, score=value, gain=now - value, state=after)


def exactly(item: Candidate, score: Score, now: float, work: Work) -> Candidate:
    """Simulate a candidate exactly: what steps of time miss may look like an effect."""
    if item.state is None:
        return item
    after, value = work.finished(item.state, score)
    return replace(item, state=after, score=value, gain=now - value)


def held_back(item: Candidate, before: State, score: Score) -> Candidate:
    """Judge a finalist that pays on records that did not fit it."""
    if item.state is None or item.gain < PAYS:
        return item
    gain, held = cross_validated(before, item.state, score, item.gain)
    worse = item.score + item.gain - gain
    return replace(item, score=worse, gain=gain, held_back=held)
