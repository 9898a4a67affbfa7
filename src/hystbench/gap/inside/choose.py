"""Choosing among hypotheses of forces, and telling the choice as rounds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from hystbench.gap.effects import effects
from hystbench.gap.fitting.least_squares import Fitted
from hystbench.gap.fitting.model_score import score_of
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.naming.rounds import Candidate, Round, SecondLook
from hystbench.gap.records.floor import Floor
from hystbench.gap.thresholds import CERTAIN, FURTHER, PAYS, SCALE, UNNAMED_SHARE


def for_a_further(taken: float, share: float) -> float:
    """Give what a further effect must lower the score by.

    One that takes less of the gap than may stay unnamed has to be beyond doubt.
    """
    return FURTHER if taken > share else CERTAIN


def charged(
    item: Fitted, found: Sequence[Fitted], square: float, share: float = UNNAMED_SHARE
) -> float:
    """Give the score with what effects have to pay: the first, and each further one.

    A further one must take a share of the gap that matters, or be beyond doubt: what is
    left after the right force is also what its law, or the simulation, misses.
    """
    gap, value = found[0].state.gap(square), item.score
    for before, after in pairwise((found[0], *way_to(item, found))):
        taken = after.state.share(before.state, square, gap)
        value += for_a_further(taken, share) if before.effects else PAYS
    return value


def way_to(item: Fitted, found: Sequence[Fitted]) -> list[Fitted]:
    """Give hypotheses of one effect more each, up to one with all of them.

    The effect that is missed least comes last, and so on.
    """
    way = [item] if item.effects else []
    while way and len(way[0].effects) > 1:
        fewer = [
            other
            for other in found
            if {*other.effects} < {*way[0].effects}
            and len(other.effects) == len(way[0].effects) - 1
        ]
        way.insert(0, min(fewer, key=lambda other: other.score))
    return way


def with_a_way(found: Sequence[Fitted]) -> list[Fitted]:
    """Keep hypotheses that :func:`way_to` leads to, in their order."""
    reached = {frozenset(item.effects) for item in found if len(item.effects) < 2}
    for item in sorted(found, key=lambda item: len(item.effects)):
        own = frozenset(item.effects)
        if any(own - {name} in reached for name in own):
            reached.add(own)
    return [item for item in found if frozenset(item.effects) in reached]


def chosen(
    found: Sequence[Fitted],
    square: float,
    share: float = UNNAMED_SHARE,
    allowed: Callable[[Fitted], bool] = lambda item: True,
) -> Fitted:
    """Take the least score with what effects have to pay; of a tie the fewest numbers.

    Only what is allowed is taken, and the host alone, which comes first.

    Bouc and Wen's hysteresis that yields at once is dry friction, which has one number.
    As many numbers have a weight that turns a little and a spring that grows softer:
    then it is the effect that is offered only where its cause can be.
    """
    values = [
        charged(item, found, square, share)
        if item is found[0] or allowed(item)
        else np.inf
        for item in found
    ]
    best = found[int(np.argmin(values))]
    tied = [
        item
        for item, value in zip(found, values, strict=True)
        if value < min(values) + SCALE and len(item.effects) == len(best.effects)
    ]

    def unlikely(item: Fitted) -> tuple[float, int, float]:
        special = sum(effects()[name].special for name in item.effects)
        return item.state.freedom, -special, item.score

    return min(tied, key=unlikely)


def as_rounds(start: ModelState, best: Fitted, found: Sequence[Fitted]) -> list[Round]:
    """Write how the effects were found as rounds: each beside those before it.

    They come in the order of :func:`way_to`. What could stand in the place of an effect
    that others came beside later is told by hypotheses with those others.
    """
    rounds: list[Round] = []
    before, now, already = start, found[0].score, frozenset[str]()
    for taken in way_to(best, found):
        (effect,) = {*taken.effects} - already
        ranking = _ranked(effect, already, found, now)
        rounds.append(Round(before, now, ranking, True))
        before, now = taken.state, taken.score
        already = frozenset(taken.effects)
    if len(rounds) > 1:
        looks = tuple(
            _look(one.ranking[0].effect, best, found, rounds[0].score)
            for one in rounds[:-1]
        )
        rounds[-1] = replace(rounds[-1], looks=looks)
    return rounds


def not_taken(start: ModelState, found: Sequence[Fitted]) -> Round:
    """Write effects of which none pays beside a model as a round that adds nothing."""
    now, single = found[0].score, [x for x in found if len(x.effects) == 1]
    best = min(single, key=lambda item: item.score).effects[0]
    return Round(start, now, _ranked(best, frozenset(), found, now), False)


def _look(
    effect: str, best: Fitted, found: Sequence[Fitted], alone: float
) -> SecondLook:
    """Rank what was tried in the place of an effect beside the others of a model."""
    others = frozenset(best.effects) - {effect}
    without = (x.score for x in found if frozenset(x.effects) == others)
    now = next(without, alone)
    beside = tuple(x for x in best.effects if x != effect)
    return SecondLook(effect, beside, _ranked(effect, others, found, now), effect)


def _ranked(
    effect: str, already: frozenset[str], found: Sequence[Fitted], now: float
) -> tuple[Candidate, ...]:
    """Rank hypotheses of one effect more than others; that with ``effect`` leads."""
    candidates = (
        _candidate(item, already, now)
        for item in found
        if already < {*item.effects} and len(item.effects) == len(already) + 1
    )
    return tuple(sorted(candidates, key=lambda x: (x.effect != effect, x.score)))


def _candidate(item: Fitted, already: frozenset[str], now: float) -> Candidate:
    """Give the effect that a hypothesis has beyond those of the rounds before."""
    state = item.state
    last = next(x for x in state.added if x.effect not in already)
    return Candidate(
        last.effect, last.place, last.form, item.score, now - item.score, state
    )


def has_free_form(state: ModelState) -> bool:
    """Tell whether an effect has a form that bends to much of what is there."""
    return any(x.form in effects()[x.effect].free_forms for x in state.added)


def bends(state: ModelState) -> bool:
    """Tell whether a free form, as a path is, or a law of many numbers is in a model.

    Both bend to much of what is there.
    """
    return has_free_form(state) or any(x.is_of_many_numbers for x in state.added)


def most_inside(chain: Named, floor: Floor) -> float:
    """Give how many effects inside could do better than what a chain has found.

    They have to lower its score by what an effect has to gain, and by what a further
    effect has to for each that the chain does not have. Where the chain leaves so
    little that nothing can, they have to be fewer. What bends to much of what is there
    says nothing of what could do better.
    """
    state = chain.state
    if bends(state):
        return np.inf
    score = Score.plain(state.sample, floor.square)
    left = score_of(state, score) - score.least(state.freedom)
    return len(state.added) + float((left - PAYS) // FURTHER if left >= PAYS else -1)


def least(found: Sequence[Fitted]) -> Fitted:
    """Give the hypothesis that scores least."""
    return min(found, key=lambda item: item.score)


def best_of_each(found: Sequence[Fitted]) -> list[Fitted]:
    """Keep of each set of effects the hypothesis that scores least, in their order.

    Of laws that cannot be told apart it is the one of the fewest numbers.
    """
    alike: dict[frozenset[str], list[Fitted]] = {}
    for item in found:
        alike.setdefault(frozenset(item.effects), []).append(item)
    best = []
    for own in alike.values():
        most = least(own).score + SCALE
        near = [item for item in own if item.score <= most]
        fewest = min(near, key=lambda item: (item.state.freedom, item.score))
        best.append(fewest)
    return best


def may_gain(item: Fitted, score: Score) -> bool:
    """Tell whether a further force could gain what it has to pay."""
    pays = FURTHER if item.effects else PAYS
    return item.score - score.least(item.state.freedom) > pays
