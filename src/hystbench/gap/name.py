"""Naming: the base alone, then every effect, added while something pays."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from hystbench.errors import InputError
from hystbench.gap.effects import effects
from hystbench.gap.effects.base import Effect
from hystbench.gap.fit import Trial, finished, score_of
from hystbench.gap.held_back import gain_held_back
from hystbench.gap.reshape import orthonormal
from hystbench.gap.score import Score
from hystbench.gap.state import State, at_end, without_effect
from hystbench.gap.work import IN_PROCESS, Tried, Work

PAYS = 40.0
"""By how much an effect must lower the score to be named."""
PAYS_HELD_BACK = 20.0
"""The same on records that did not fit it, where no parameter is charged."""
NEAR = 80.0
"""Variants that score worse than the best by more are not searched further."""
STILL = 0.5
"""The same as a share of the best's gain: a grid's step may miss much of a gain."""
FINALISTS = 6
"""Effects that are added and refitted jointly before one is taken."""
TIE = 6.0
"""Effects whose score differs by less cannot be told apart."""
MOST = 4
"""Effects that are added, at most."""

WORSE = 0.1
"""Share by which an effect may widen the gap, where a wrong shape hides what it does.

Without this a gain near zero would leave all to the reshaping of the hysteresis.
"""

EXACT = 3
"""Of the finalists, those that are simulated exactly before one is taken."""
FURTHER = 100.0
"""By how much a further effect must lower the score."""
MATTERS = 0.01
"""Share of the gap's power that makes a further effect matter."""
CERTAIN = 200.0
"""By how much one that matters less must lower the score."""
BESIDE_SHAPE = 0.1
"""Share that matters beside a hysteresis of the wrong shape."""
MOST_OF_IT = 0.3
"""Share that makes a wrong shape of the hysteresis matter, dear as it is charged."""
SWAP = 3.0
"""By how much a rival must score better to take an effect's place."""
CLOSE = 0.6
"""Rivals are those with this share of the gain of the best of a round."""
SHAPE = "hysteresis-shape"

Say = Callable[[str], None]


def silent(line: str) -> None:
    """Say nothing."""


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
    """

    effect: str
    place: str
    form: str = ""
    score: float = np.inf
    gain: float = 0.0
    state: State | None = None
    declined: str = ""


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


@dataclass(frozen=True)
class Named:
    """What naming found.

    Parameters
    ----------
    state : State
        The model with all effects that were added.
    rounds : tuple of Round
    reasons : dict of str to tuple of Candidate
        The ranking by which each added effect was taken.
    """

    state: State
    rounds: tuple[Round, ...] = ()
    reasons: dict[str, tuple[Candidate, ...]] = field(default_factory=dict)


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


def name(state: State, floor_rms: float, say: Say = silent) -> Named:
    """Add effects to a model for as long as one pays."""
    return settled(_path(state, floor_rms, say), state, floor_rms, say)


def settled(found: Progress, start: State, floor_rms: float, say: Say) -> Named:
    """Give what a path found, or another where a wrong shape is to go first.

    Where a wrong shape of the hysteresis takes more of the gap away than the effect
    that scores best, that effect may still be one of several that do without it. So
    they are tried first; if the shape is needed after all, it goes first.
    """
    if found.deferred and any(item.effect == SHAPE for item in found.state.added):
        say(f"{SHAPE} is needed and takes most of the gap away: it goes first")
        found = _path(start, floor_rms, say, shape_first=True)
    state = without_needless(found.state, floor_rms, say)
    if state.added:
        # Its own numbers are found without what other forms of it could do.
        state, _ = finished(state, make_score(state, floor_rms, forms=False))
    return Named(state, found.rounds, found.reasons)


@dataclass(frozen=True)
class Progress:
    """How far adding effects one by one has come.

    Parameters
    ----------
    state : State
    gap : float
        Mean square of the base's gap above the floor.
    rounds : tuple of Round
    deferred : bool
        Whether a shape that takes more of the gap was put off.
    reasons : dict of str to tuple of Candidate
        The ranking by which each added effect was taken.
    closed : bool
        Whether nothing is left that an effect could gain.
    """

    state: State
    gap: float
    rounds: tuple[Round, ...] = ()
    deferred: bool = False
    reasons: dict[str, tuple[Candidate, ...]] = field(default_factory=dict)
    closed: bool = False

    @classmethod
    def begun(cls, state: State, floor_rms: float) -> Progress:
        """Start from the base, re-tuned where it has free numbers."""
        floor = floor_rms**2
        if state.free:
            state, _ = finished(state, make_score(state, floor_rms))
        return cls(state, max(state.power(floor), floor * 1e-6))

    @property
    def done(self) -> bool:
        """Whether nothing more is to be added."""
        stopped = bool(self.rounds) and not self.rounds[-1].taken
        return stopped or self.closed or len(self.state.added) >= MOST


def _path(
    state: State, floor_rms: float, say: Say, shape_first: bool = False
) -> Progress:
    """Add effects one by one."""
    progress = Progress.begun(state, floor_rms)
    while not progress.done:
        progress = advance(progress, floor_rms, say, shape_first)
    return progress


def advance(
    progress: Progress,
    floor_rms: float,
    say: Say,
    shape_first: bool = False,
    work: Work = IN_PROCESS,
) -> Progress:
    """Try every effect beside the model and add the one that pays, if any does."""
    floor, state = floor_rms**2, progress.state
    score = make_score(state, floor_rms)
    if state.added and score_of(state, score) - score.least(state.freedom) < FURTHER:
        say("nothing is left that an effect could gain")
        return replace(progress, closed=True)
    ranking = rank(state, score, work=work)
    reasons = dict(progress.reasons)
    deferred = progress.deferred
    if _shape_takes_more(ranking, state, floor):
        deferred = True
        if shape_first:
            ranking = tuple(sorted(ranking, key=lambda x: x.effect != SHAPE))
    first = ranking[0]
    for item in ranking[:4]:
        say(f"{item.effect} {item.form}: gain {item.gain:.1f}")
    taken = _pays(first, state, floor, progress.gap)
    if taken and first.state is not None:
        held_back = gain_held_back(state, first.state, score)
        say(f"{first.effect}: {held_back:.1f} of it on records held back")
        taken = held_back > PAYS_HELD_BACK
    one = Round(state, first.score + first.gain, ranking, taken)
    rounds = (*progress.rounds, one)
    if taken:
        assert first.state is not None  # noqa: S101  (for the type checker)
        state = first.state
        reasons[first.effect] = ranking
        if len(state.added) > 1:
            state, again = reconsidered(state, rounds, floor_rms, say)
            reasons |= again
    return Progress(state, progress.gap, rounds, deferred, reasons)


def _shape_takes_more(
    ranking: tuple[Candidate, ...], before: State, floor: float
) -> bool:
    """Tell whether a wrong shape pays and takes twice as much as the best effect."""
    shape = next((x for x in ranking if x.effect == SHAPE and x.state), None)
    first = ranking[0]
    if shape is None or shape.state is None or first.state is None:
        return False
    if shape is first or shape.gain < PAYS:
        return False
    gap = before.power(floor)
    most = shape.state.share(before, floor, gap)
    return first.state.share(before, floor, gap) < most / 2


def _pays(item: Candidate, state: State, floor: float, gap: float) -> bool:
    """Tell whether an effect is to be added.

    The first has only to pay. A further one must matter as well, or be beyond doubt:
    what is left after the right effect is also what its form, or the simulation,
    misses.
    """
    if item.state is None or item.gain < PAYS:
        return False
    if not state.added:
        return True
    beside_shape = any(other.effect == SHAPE for other in state.added)
    matters = BESIDE_SHAPE if beside_shape else MATTERS
    share = item.state.share(state, floor, gap)
    if item.effect == SHAPE and share > MOST_OF_IT:
        return True
    return item.gain > CERTAIN or (item.gain > FURTHER and share > matters)


def reconsidered(
    state: State, rounds: Sequence[Round], floor_rms: float, say: Say
) -> tuple[State, dict[str, tuple[Candidate, ...]]]:
    """Try the rivals of each effect in its place, now that others are there.

    The first effect was named while the others were missing: one like it may have
    looked better for that.

    Returns
    -------
    state : State
    rankings : dict of str to tuple of Candidate
        Of the effects that were looked at again.
    """
    rankings: dict[str, tuple[Candidate, ...]] = {}
    for number, item in enumerate(state.added):
        if item.effect == SHAPE:
            continue
        score = make_score(state, floor_rms)
        now = score_of(state, score)
        short = without_effect(state, number)
        have = {other.effect for other in short.added}
        names = _rivals(item.effect, rounds) - have
        ranking = rank(short, score, [effects()[name] for name in sorted(names)])
        best = ranking[0]
        other = best.state is not None and best.effect != item.effect
        if other and best.score < now - SWAP:
            gain = now - best.score
            say(f"{item.effect} gives way to {best.effect}: {gain:.1f}")
            return best.state or state, {**rankings, best.effect: ranking}
        rankings[item.effect] = ranking
    return state, rankings


def without_needless(state: State, floor_rms: float, say: Say) -> State:
    """Take effects out again that gain too little beside those that were added later.

    An effect is judged by what can be reshaped without it: other forms of itself would
    stand in for it.
    """
    for number, item in enumerate(state.added if len(state.added) > 1 else ()):
        short = without_effect(state, number)
        score = make_score(short, floor_rms)
        short, value = finished(short, score)
        gain = value - score_of(state, score)
        if gain < FURTHER:
            say(f"{item.effect} is needless beside the others: gain {gain:.1f}")
            return without_needless(short, floor_rms, say)
    return state


def _rivals(effect: str, rounds: Sequence[Round]) -> set[str]:
    found = {effect}
    for one in rounds:
        best = one.ranking[0].gain
        near = {x.effect for x in one.ranking if x.gain > CLOSE * best}
        if effect in near:
            found |= near
    return found
