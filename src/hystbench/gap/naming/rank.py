"""Every effect beside a model, tried and ranked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hystbench.blocks.calls import USED_UP, CallsUsedUp, current
from hystbench.blocks.simulator import Simulator
from hystbench.device_kinds import behaviour_of
from hystbench.errors import InputError
from hystbench.gap.effects import among, effects
from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.hysteresis import Hysteresis
from hystbench.gap.effects.variant import Variant
from hystbench.gap.fitting.edit_chain import at_end
from hystbench.gap.fitting.model_score import score_of
from hystbench.gap.fitting.refit import added, finished, refit
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Added, ModelState
from hystbench.gap.fitting.tried import on_all_records, seen
from hystbench.gap.fitting.variant_search import Trial, fine, fine_each
from hystbench.gap.naming.rivals import (
    beside_their_own_shapes,
    beyond_simpler_laws,
    by_all_their_laws,
    first_on_folds,
    on_folds,
    simplest_of_a_tie,
)
from hystbench.gap.naming.rounds import (
    WIDER,
    Candidate,
    TriedVariant,
    best_forms,
    each_candidate,
    in_order,
)
from hystbench.gap.thresholds import CERTAIN, LOOSE, PAYS, SCALE, SHAPE

NEAR = 80.0
"""Variants that score worse than the best by more are not searched further."""
STILL = 0.5
"""The same as a share of the best's gain: a grid's step may miss much of a gain."""
FINALISTS = 6
"""Effects that are added and refitted jointly before one is taken."""
BEHIND = 0.75
"""Share of the best's gain that one of them may lack: a refit makes up for less."""
EXACT = 3
"""Finalists that are simulated exactly before one is taken."""
FITTED_WITH_IT = "the shape of a hysteresis whose weights are free is fitted with it"
AT_AN_END = "fits best at the end of what it can be"
ALIKE_WITHOUT = "the same curves fit alike without"
SLOW_NOISE = "has less power than the noise, a part of which is slow"


def rank(
    state: ModelState,
    score: Score,
    known: Sequence[Effect] | None = None,
    folds: bool = True,
    needs: float = 0.0,
) -> tuple[Candidate, ...]:
    """Try every effect beside a model, the likely ones to the end.

    Parameters
    ----------
    state : ModelState
    score : Score
    known : sequence of Effect, optional
        All that are offered by default.
    folds : bool
        Whether finalists that pay are judged anew on folds.
    needs : float
        What an effect has to gain to be taken. One that gains too little of it on its
        grid for a search and a refit to make up for is as good as it will be.

    Returns
    -------
    tuple of Candidate
        Finalists first, then the others, then those that declined.
    """
    known = tuple(among(state.offered).values()) if known is None else tuple(known)
    now, worth = score_of(state, score), needs * (1 - BEHIND)
    found, declined = _first_looks(known, state, score, now, worth)
    if not found:
        return tuple(declined)
    most = now - min(trial.score for trial in found)
    refined = _refined(found, now, max(_near(most), worth))
    likely = _likely(refined, now, max(most * (1 - BEHIND), worth), state)
    # A form that bends far on all records may still foretell none of them.
    judged = best_forms(
        _each_judged(likely, refined, state, score, now, folds),
        lambda item: on_folds(item, state, score).score,
    )
    finalists = {trial.variant.effect for trial in likely}
    others = [x for x in _best_of_each(refined) if x.variant.effect not in finalists]
    judged += [_candidate(trial, now) for trial in others]
    judged = [replace(x, variants=_laws_of(x.effect, refined)) for x in judged]
    candidates = in_order(_not_cut_short(x, state) for x in (*declined, *judged))
    candidates, exact = _best_exact(candidates, state, score, now)
    candidates = beside_their_own_shapes(candidates, exact, state, score.floor)
    if folds:
        candidates = _first_exact(candidates, exact, state, score, now)
    candidates = beyond_simpler_laws(by_all_their_laws(candidates), state, score)
    return tuple(simplest_of_a_tie(candidates, exact, needs) if folds else candidates)


def _first_looks(
    known: Sequence[Effect], state: ModelState, score: Score, now: float, worth: float
) -> tuple[Sequence[Trial], list[Candidate]]:
    """Try effects on some samples, and what gains enough there on all.

    Beside these trials stand the effects that declined.
    """
    places, have = {x.name: x.place for x in known}, {x.effect for x in state.added}
    why_not = {name: "added already" for name in places if name in have}
    if SHAPE in places and _loop_is_free(state):
        why_not.setdefault(SHAPE, FITTED_WITH_IT)
    asked = [effect for effect in known if effect.name not in why_not]
    looks, declined = seen(asked, state, score)
    found, refused = on_all_records(
        looks, now, lambda most: max(min(_near(most), most * (1 - BEHIND)), worth)
    )
    why_not |= declined
    why_not |= {name: refused[name] for name in places if name in refused}
    return found, [Candidate(x, places[x], declined=y) for x, y in why_not.items()]


def _best_of_each(refined: Sequence[Trial]) -> list[Trial]:
    """Give the first trial of each effect: the best, as they are in order."""
    first: dict[str, Trial] = {}
    for trial in refined:
        first.setdefault(trial.variant.effect, trial)
    return list(first.values())


def _likely(
    refined: Sequence[Trial], now: float, least: float, state: ModelState
) -> list[Trial]:
    """Choose the trials that are refitted: several of an effect, if need be.

    First the best of each effect that gains nearly as much as any. Then those that
    begin at numbers of their own, beside other effects only of those chosen first, and
    all of an effect that is expected. Then laws of fewer numbers of these.
    """
    likely = [
        trial
        for number, trial in enumerate(_best_of_each(refined))
        if (number < FINALISTS and trial.score < now - least)
        or (trial.variant.effect == SHAPE and now - trial.score > PAYS)
    ]
    shown = {trial.variant.effect: trial for trial in likely}
    others = [x for x in refined if shown.get(x.variant.effect) is not x]
    begun = [
        trial
        for trial in others
        if trial.variant.effect == state.expected
        or (trial.variant.begun and (not state.added or trial.variant.effect in shown))
    ]
    fewer = _of_fewer_numbers(refined, [shown[x] for x in sorted(shown)], now)
    return [*likely, *begun, *fewer]


def _laws_of(effect: str, refined: Sequence[Trial]) -> tuple[TriedVariant, ...]:
    """Give what was tried of an effect, each law by the better of its starts."""
    laws: dict[tuple[object, ...], TriedVariant] = {}
    for trial in refined:
        if trial.variant.effect == effect:
            one = _tested(trial)
            laws.setdefault(one[:-1], one)
    return tuple(laws.values())


def _best_exact(
    candidates: Sequence[Candidate], state: ModelState, score: Score, now: float
) -> tuple[list[Candidate], list[str]]:
    """Simulate the best candidates exactly. Beside all, in order, stand their names."""
    close = [
        item for item in candidates[:EXACT] if item.score < candidates[0].score + NEAR
    ]
    again = each_candidate(
        lambda item: exactly(item, score, now), close, state, "exact refits"
    )
    exact = {item.effect: item for item in again}
    return in_order(exact.get(item.effect, item) for item in candidates), list(exact)


def _first_exact(
    candidates: Sequence[Candidate],
    exact: list[str],
    state: ModelState,
    score: Score,
    now: float,
) -> list[Candidate]:
    """Judge candidates on folds till the first one was simulated exactly as well.

    What is simulated here is added to ``exact``.
    """
    found = first_on_folds(candidates, state, score)
    candidates = in_order(_not_cut_short(item, state) for item in found)
    while candidates[0].effect not in exact and candidates[0].gain_on_folds is not None:
        first = candidates.pop(0)
        exact.append(first.effect)
        again = on_folds(exactly(first, score, now), state, score)
        # Behind it there may now be one that could not be the first before.
        found = first_on_folds(in_order([again, *candidates]), state, score)
        candidates = in_order(found)
    return candidates


def _near(gain: float) -> float:
    """Give the least gain on a grid that a search may bring up to so much."""
    return gain - max(NEAR, gain * STILL)


def _loop_is_free(state: ModelState) -> bool:
    """Tell whether the chain's hysteresis is one that was added, or whose weights are.

    Then it has no other shape than that which is fitted.
    """
    if any(item.effect == Hysteresis.name for item in state.added):
        return True
    loop = state.simulation.hysteresis
    return any(x.block == loop and x.parameter == "weights" for x in state.free)


def _refined(found: Sequence[Trial], now: float, least: float) -> list[Trial]:
    """Search around the best points of grids that gain enough; the least score first.

    A grid's step may miss most of what the right law does. So of their effects the laws
    of fewer numbers are searched as well, whatever they gain, as a step misses more of
    a law of few numbers; and of the effect that then does best, all its laws.
    """
    most: dict[str, float] = {}
    for trial in found:
        own = trial.variant
        if now - trial.score > least:
            most[own.effect] = max(most.get(own.effect, 0.0), own.freedom)
    near = [
        now - x.score > least or x.variant.freedom < most.get(x.variant.effect, 0.0)
        for x in found
    ]
    every, places = list(found), np.flatnonzero(near).tolist()
    for k, trial in zip(places, fine_each([found[k] for k in places]), strict=True):
        every[k] = trial
    first = min(range(len(every)), key=lambda k: every[k].score)
    best = every[first].variant
    for k, trial in enumerate(found if near[first] else ()):
        own = trial.variant
        if not near[k] and own.effect == best.effect and own.form != best.form:
            every[k] = fine(trial)
    return sorted(every, key=lambda trial: trial.score)


def _tested(trial: Trial) -> TriedVariant:
    variant = trial.variant
    position = variant.start + variant.positions[0] if variant.positions else None
    return TriedVariant(variant.place, variant.form, position, trial.score)


def _candidate(trial: Trial, now: float) -> Candidate:
    variant = trial.variant
    gain = now - trial.score
    return Candidate(variant.effect, variant.place, variant.form, trial.score, gain)


def _each_judged(
    likely: Sequence[Trial],
    every: Sequence[Trial],
    state: ModelState,
    score: Score,
    now: float,
    folds: bool,
) -> list[Candidate]:
    """Judge effects, the likeliest first.

    Where a block refuses the numbers of an effect's best law, the next one is judged.
    What is not judged on folds only has to do better than one that stands: far behind
    the best so far, beyond what a free form is charged beside it, a refit ends early.
    """

    def judge(trial: Trial, wanted: float = np.inf) -> Candidate:
        item = _judged(trial, state, score, now, wanted)
        if not item.refused:
            return item
        others = (x for x in every if _is_other_law(x.variant, trial.variant))
        judged = (_judged(x, state, score, now, wanted) for x in others)
        return next((x for x in judged if not x.declined), item)

    if folds:
        return each_candidate(judge, likely, state, "refits")
    found: list[Candidate] = []
    wanted = np.inf
    for trial in likely:
        found.append(judge(trial, wanted))
        if found[-1].state is not None:
            wanted = min(wanted, found[-1].score + CERTAIN + NEAR)
    return found


def _of_fewer_numbers(
    every: Sequence[Trial], best: Sequence[Trial], now: float
) -> list[Trial]:
    """Give laws of fewer numbers that may catch up with the best one of their effect.

    A refit makes up for what steps of a search miss of them; else another effect that
    does the same would be told apart from theirs.
    """
    found: dict[tuple[str, str], Trial] = {}
    for one in best:
        for trial in every:
            few = trial.variant.freedom < one.variant.freedom
            near = now - trial.score > STILL * (now - one.score)
            if few and near and _is_other_law(trial.variant, one.variant):
                found.setdefault((trial.variant.effect, trial.variant.form), trial)
    return list(found.values())


def _is_other_law(variant: Variant, of: Variant) -> bool:
    """Tell whether a variant is another law of the same effect."""
    return variant.effect == of.effect and variant.form != of.form and not variant.begun


def _judged(
    trial: Trial, state: ModelState, score: Score, now: float, wanted: float
) -> Candidate:
    """Add an effect that gains anything, refit all together, and say what is wrong."""
    variant = trial.variant
    item = _candidate(trial, now)
    if item.gain <= 0 and not variant.begun:
        return item

    try:
        after, value = added(state, trial, score, wanted)
    except InputError as error:
        return replace(item.but(f"fits best where {error}"), refused=True)
    if end := at_end(after):
        return item.but(f"{AT_AN_END}: {end}")
    of_noise = variant.beside is not None and effects()[variant.effect].like_noise
    if of_noise and state.power(0.0) - after.power(0.0) < score.floor:
        return item.but(SLOW_NOISE)
    if does_without_itself(after, after.added[-1], value, score):
        return item.but(f"{ALIKE_WITHOUT} {behaviour_of(variant.effect)}")
    hidden = score.directions.shape[1] > 0  # what a wrong shape may do hardly counts
    power = state.power(score.floor)
    if hidden and after.share(state, score.floor, power) < -LOOSE:
        return item.but(WIDER)
    return replace(item, score=value, gain=now - value, state=after)


def does_without_itself(
    state: ModelState, item: Added, value: float, score: Score
) -> bool:
    """Tell whether a model fits alike without what makes an effect that effect.

    ``value`` is what it scores with it.
    """
    bare = effects()[item.effect].without_itself([state.chain[k] for k in item.blocks])
    if bare is None:
        return False
    without = state.with_blocks(dict(zip(item.blocks, bare, strict=True)))
    free = tuple(
        x for x in state.free if x.block not in item.blocks or without.value(x) != 0.0
    )
    return refit(replace(without, free=free), score)[1] < value + SCALE


def _not_cut_short(item: Candidate, state: ModelState) -> Candidate:
    """Decline what needs calls of a simulator, once a call was not allowed.

    Its refit or its folds may have ended before they were done. What lies behind the
    simulator needs no call.
    """
    if not current().refused() or not item.variants or item.declined:
        return item
    places = [k for k, x in enumerate(state.chain) if isinstance(x, Simulator)]
    position = item.variants[0].position
    if not places or position is None or position > places[-1]:
        return item
    return item.but(USED_UP)


def exactly(item: Candidate, score: Score, now: float) -> Candidate:
    """Simulate a candidate exactly: what steps of time miss may look like an effect."""
    if item.state is None:
        return item
    try:
        after, value = finished(item.state, score)
    except CallsUsedUp as error:
        return item.but(str(error))
    if end := at_end(after):
        return item.but(f"{AT_AN_END}: {end}")
    return replace(item, state=after, score=value, gain=now - value)
