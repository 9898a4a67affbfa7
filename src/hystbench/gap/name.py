"""Naming: the base alone, then every effect, added while something pays."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from hystbench.errors import InputError
from hystbench.gap.effects import effects
from hystbench.gap.effects.base import Declined, Effect
from hystbench.gap.fit import Attempt, Trial, added, coarse, fine, finished, score_of
from hystbench.gap.reshape import directions
from hystbench.gap.score import Score
from hystbench.gap.state import State

PAYS = 40.0
"""By how much an effect must lower the score to be named."""
NEAR = 80.0
"""Variants that score worse than the best by more are not searched further."""
FINALISTS = 6
"""Effects that are added and refitted jointly before one is taken."""
TIE = 6.0
"""Effects whose score differs by less cannot be told apart."""
MOST = 4
"""Effects that are added, at most."""

Say = Callable[[str], None]


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

    @property
    def rivals(self) -> tuple[str, ...]:
        """Effects that cannot be told from the first."""
        first = self.ranking[0]
        return tuple(
            item.effect
            for item in self.ranking[1:]
            if item.state is not None and item.score < first.score + TIE
        )


@dataclass(frozen=True)
class Named:
    """What naming found.

    Parameters
    ----------
    state : State
        The model with all effects that were added.
    rounds : tuple of Round
    """

    state: State
    rounds: tuple[Round, ...] = field(default=())


def make_score(state: State, floor_rms: float) -> Score:
    """Give the score for a model: what its hysteresis could do is spanned anew."""
    return Score(state.sample, directions(state.scene, state.sample), floor_rms**2)


def try_effect(
    effect: Effect, state: State, score: Score
) -> tuple[list[tuple[Attempt, Trial]], str]:
    """Score every variant of an effect over its grid; or say why it declines."""
    try:
        attempts = [Attempt(state, item, score) for item in effect.variants(state.scene)]
    except Declined as reason:
        return [], str(reason)
    return [(attempt, coarse(attempt)) for attempt in attempts], ""


def rank(
    state: State, score: Score, known: Sequence[Effect] | None = None
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
    found: list[tuple[Attempt, Trial]] = []
    declined = []
    for effect in known:
        if effect.name in have:
            declined.append(
                Candidate(effect.name, effect.place, declined="added already")
            )
            continue
        trials, why = try_effect(effect, state, score)
        found += trials
        if why:
            declined.append(Candidate(effect.name, effect.place, declined=why))
    best = min(trial.score for _, trial in found)
    refined = []
    for attempt, trial in found:
        if trial.score < best + NEAR:
            trial = fine(attempt, trial)
        refined.append(trial)
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
        if number < FINALISTS and now - value > 0:
            try:
                after, value = added(state, trial, score)
            except InputError as error:
                declined.append(Candidate(*own[:2], declined=f"fits best where {error}"))
                continue
        candidates.append(Candidate(*own, value, now - value, after))
    candidates.sort(key=lambda item: (item.state is None, item.score))
    return (*candidates, *declined)


def name(
    state: State, floor_rms: float, say: Say = lambda line: None
) -> Named:
    """Add effects to a model for as long as one pays."""
    rounds = []
    while len(state.added) < MOST:
        score = make_score(state, floor_rms)
        ranking = rank(state, score)
        first = ranking[0]
        taken = first.gain > PAYS and first.state is not None
        rounds.append(Round(state, first.score + first.gain, ranking, taken))
        for item in ranking[:4]:
            say(f"{item.effect} {item.form}: gain {item.gain:.1f}")
        if not taken:
            break
        assert first.state is not None  # noqa: S101  (for the type checker)
        state, _ = finished(first.state, score)
    return Named(state, tuple(rounds))
