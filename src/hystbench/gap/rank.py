"""One round: every effect beside a model, tried and ranked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from hystbench.errors import InputError
from hystbench.gap.change import at_end
from hystbench.gap.effects import effects
from hystbench.gap.effects.base import Effect
from hystbench.gap.fit import score_of
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


@dataclass(frozen=True)
class Candidate:
    """An effect as it did in one round.

    Parameters
    ----------
    effect, place, form : str
    score : float
    gain : float
        By how much it lowers the score.
    state : State, optional
        With the effect, jointly refitted; finalists have it.
    declined : str
        Why it could not be judged, if so.
    held_back : float, optional
        What it gains on records held back; of the best one, where that had to decide
        whether it is taken.
    """

    effect: str
    place: str
    form: str = ""
    score: float = np.inf
    gain: float = 0.0
    state: State | None = None
    declined: str = ""
    held_back: float | None = None


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
    """

    before: State
    score: float
    ranking: tuple[Candidate, ...]
    taken: bool


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
    found: list[Tried] = []
    declined = []
    for effect in known:
        if effect.name in have:
            declined.append(
                Candidate(effect.name, effect.place, declined="added already")
            )
            continue
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
    for trial in refined:
        of_effect.setdefault(trial.variant.effect, trial)
    candidates = []
    for number, trial in enumerate(of_effect.values()):
        variant = trial.variant
        own = (variant.effect, variant.place, variant.form)
        after = None
        value = trial.score
        likely = number < FINALISTS or (variant.effect == SHAPE and now - value > PAYS)
        if likely and now - value > 0:
            try:
                after, value = work.added(state, trial, score)
            except InputError as error:
                declined.append(
                    Candidate(*own[:2], declined=f"fits best where {error}")
                )
                continue
            end = at_end(after, variant)
            if end:
                why = f"fits best at the end of what it can be: {end}"
                declined.append(Candidate(*own[:2], declined=why))
                continue
            power = state.power(score.floor)
            if after.share(state, score.floor, power) < -WORSE:
                declined.append(Candidate(*own[:2], declined="makes the gap wider"))
                continue
        candidates.append(Candidate(*own, value, now - value, after))
    candidates.sort(key=lambda item: (item.state is None, item.score))
    candidates = [
        exactly(item, score, now, work)
        if place < EXACT and item.score < candidates[0].score + NEAR
        else item
        for place, item in enumerate(candidates)
    ]
    candidates.sort(key=lambda item: (item.state is None, item.score))
    return (*candidates, *declined)


def exactly(item: Candidate, score: Score, now: float, work: Work) -> Candidate:
    """Simulate a candidate exactly: what steps of time miss may look like an effect."""
    if item.state is None:
        return item
    after, value = work.finished(item.state, score)
    return replace(item, state=after, score=value, gain=now - value)
