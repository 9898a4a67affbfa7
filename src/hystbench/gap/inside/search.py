"""Forces in a linear host: singles, then pairs, then three, all numbers refitted."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import ceil
from typing import Any

import numpy as np

from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.parameter import HUGE
from hystbench.blocks.store import Store
from hystbench.gap.effects import among, effects
from hystbench.gap.effects.law import Changed, Law, Moved
from hystbench.gap.fitting.edit_chain import without_effect
from hystbench.gap.fitting.least_squares import (
    QUICK,
    Fitted,
    fitted,
    fitted_to_the_end,
    judged,
    record_weights,
)
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.beginnings import Beginnings, with_numbers_of
from hystbench.gap.inside.put_in import evened, host_of, with_law
from hystbench.gap.inside.stores import how_it_fills, with_changed
from hystbench.gap.progress import Say, silent
from hystbench.gap.thresholds import FURTHER, PAYS, SCALE
from hystbench.record import FloatArray

SINGLES, PAIRS = 4, 2
"""Of them, so many are carried into pairs and into threes: forces that gain little
alone may gain much together."""
FEW = 4
"""Evaluations of the residual after which the worse half of the starts is left."""


@dataclass(frozen=True)
class Hypothesis:
    """A host with forces inside, fitted.

    Parameters
    ----------
    effects : tuple of str
        In the order in which they were put in.
    forms : tuple of str
        Law of each.
    fitted : Fitted
    """

    effects: tuple[str, ...]
    forms: tuple[str, ...]
    fitted: Fitted

    @property
    def score(self) -> float:
        """Score with all numbers charged."""
        return self.fitted.score


Laws = Mapping[str, Sequence[Law | Changed]]
"""What may be put into a host, by effect."""
Offer = Callable[[Fitted], Laws]
"""Gives what may be put into a fitted host."""


def laws_for(
    host: Fitted, turns: bool = False, offered: Iterable[str] | None = None
) -> Laws:
    """Give what may be put into a host.

    Parameters
    ----------
    host : Fitted
        With or without effects inside already.
    turns : bool
        Whether its coordinate is an angle.
    offered : iterable of str, optional
        Effects that may be named; all by default.
    """
    every: dict[str, tuple[Law | Changed, ...]]
    if of_stores(host):
        filled = how_it_fills(host.state)
        every = {name: tuple(x.stored(filled)) for name, x in among(offered).items()}
    else:
        moved = how_it_moves(host.state, turns)
        every = {
            name: tuple(x.in_mechanism(moved)) for name, x in among(offered).items()
        }
    return {name: own for name, own in every.items() if own}


def singles(
    host: Fitted,
    offer: Offer,
    score: Score,
    say: Say = silent,
    other: ModelState | None = None,
) -> list[Hypothesis]:
    """Try each force alone: the host without one first, then the least score.

    Forces are put into the host, or into another model that is as good without them.
    """
    alone = Hypothesis((), (), host)
    begun = replace(alone, fitted=host if other is None else replace(host, state=other))
    return [alone, *_one_more([begun], offer, score, SINGLES, host.score, say)]


def together(
    found: Sequence[Hypothesis], offer: Offer, score: Score, say: Say = silent
) -> list[Hypothesis]:
    """Go on from singles to pairs and threes.

    Returns
    -------
    list of Hypothesis
        The host alone first; of each set of effects the best laws.
    """
    every, alone, carried = list(found), found[0].score, list(found[1:])
    for keep in (PAIRS, 1):
        if not may_gain(min(every, key=lambda item: item.score), score):
            break
        if not of_stores(found[0].fitted):
            carried = [item for item in carried if item.score < alone]
        carried = _one_more(carried, offer, score, keep, alone, say)
        every += carried
    best = min(every, key=lambda item: item.score)
    if not of_stores(best.fitted):
        every += with_one_fewer(best, every, score)
    return best_of_each(every)


def with_one_fewer(
    best: Hypothesis, found: Sequence[Hypothesis], score: Score
) -> list[Hypothesis]:
    """Take each effect of a hypothesis out, where the others together were not tried.

    An effect that stood for another one before that came may be needless beside it. The
    others have to come one after the other: one fewer of them was tried as well.
    """
    if len(best.effects) < 2:
        return []
    tried = {frozenset(item.effects) for item in found}
    left = []
    for number, effect in enumerate(best.effects):
        others = tuple(x for k, x in enumerate(best.effects) if k != number)
        ways = (frozenset(others) - {one} for one in others)
        if frozenset(others) in tried or not any(way in tried for way in ways):
            continue
        state = best.fitted.state
        place = [item.effect for item in state.added].index(effect)
        forms = tuple(x for k, x in enumerate(best.forms) if k != number)
        begun = without_effect(state, place)
        left.append(Hypothesis(others, forms, Fitted(begun, np.inf)))
    return _to_the_end(left, score)


def of_stores(item: Fitted) -> bool:
    """Tell whether a model is of stores: all their laws are tried with each other.

    They are few, and the root of the level, which may be worse than a linear outflow
    alone, may be better than any other law with an overflow.
    """
    return any(isinstance(block, Store) for block in item.state.chain)


def best_of_each(found: Sequence[Hypothesis]) -> list[Hypothesis]:
    """Keep of each set of effects the hypothesis that scores least, in their order."""
    best: dict[frozenset[str], Hypothesis] = {}
    for item in found:
        effects = frozenset(item.effects)
        if effects not in best or item.score < best[effects].score:
            best[effects] = item
    return list(best.values())


def _one_more(
    carried: Sequence[Hypothesis],
    offer: Offer,
    score: Score,
    keep: int,
    alone: float,
    say: Say,
) -> list[Hypothesis]:
    """Put one more force into each hypothesis; give the best, the least score first."""
    begun = [
        further
        for before in carried
        if may_gain(before, score)
        for name, own in offer(before.fitted).items()
        if name not in before.effects
        for further in starts(before, name, own, score)
    ]
    if not begun:
        return []
    if any(of_stores(item.fitted) for item in carried):
        best_first = fitted_each(begun, score)
    else:
        beginnings = Beginnings.of(carried[0].fitted.state, score)
        best_first = fitted_likely(begun, beginnings, score, keep)
    for item in best_first[:3]:
        say(f"inside: {' + '.join(item.effects)}: gain {alone - item.score:.1f}")
    return best_first


def may_gain(item: Hypothesis, score: Score) -> bool:
    """Tell whether a further force could gain what it has to pay."""
    pays = FURTHER if item.effects else PAYS
    return item.score - score.least(item.fitted.state.freedom) > pays


def starts(
    before: Hypothesis, effect: str, laws: Sequence[Law | Changed], score: Score
) -> Iterator[Hypothesis]:
    """Put a further force inside, by each law and start, with the score to be expected.

    The residual is explained by what the force does as it starts, as one column, by
    what each of its numbers does that starts at zero, which that column does not hold,
    and by what changes of all other numbers do, by least squares.
    """
    state = before.fitted.state
    tangents, weights = state.tangents, record_weights(state)
    for law in laws:
        begun = (
            with_changed(state, effect, law)
            if isinstance(law, Changed)
            else with_law(state, effect, law)
        )
        if isinstance(law, Law) and not law.stands_for:
            begun = evened(begun)
        if not np.all(np.isfinite(begun.residual)):
            continue
        does = state.residual - begun.residual
        columns = np.column_stack([tangents, does, of_zeros(begun)])
        sizes = np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
        scaled = columns / sizes
        found, *_ = np.linalg.lstsq(
            scaled * weights[:, None], state.residual * weights, rcond=1e-8
        )
        rest = state.residual - scaled @ found
        expected = score.of(rest, begun.freedom)
        effects, forms = (*before.effects, effect), (*before.forms, law.form)
        yield Hypothesis(effects, forms, Fitted(begun, expected))


def of_zeros(begun: ModelState) -> FloatArray:
    """Give the slopes by the numbers of what was put in last that start at zero."""
    own = begun.added[-1].blocks
    zeros = (x for x in begun.free if x.block in own and begun.value(x) == 0.0)
    return replace(begun, free=tuple(zeros)).tangents


def fitted_likely(
    begun: Iterable[Hypothesis], beginnings: Beginnings, score: Score, count: int
) -> list[Hypothesis]:
    """Fit the hypotheses that promise most: roughly first, the best of them to the end.

    Parameters
    ----------
    begun : iterable of Hypothesis
        With the scores to be expected.
    beginnings : Beginnings
        What they are fitted to roughly.
    score : Score
        Of the whole records.
    count : int
        How many, each by its best start, are fitted to the end; twice as many are
        fitted roughly, each from twice as many starts.

    Returns
    -------
    list of Hypothesis
        Those that were fitted to the end, the least score first.
    """
    likely: dict[frozenset[str], list[Hypothesis]] = {}
    for item in sorted(begun, key=lambda item: item.score):
        likely.setdefault(frozenset(item.effects), []).append(item)
    rough = [
        raced(own[: 2 * count], beginnings)
        for own in list(likely.values())[: 2 * count]
    ]
    rough.sort(key=lambda pair: pair[1].score)
    begun_well = [
        replace(
            item,
            fitted=replace(own, state=with_numbers_of(item.fitted.state, own.state)),
        )
        for item, own in rough[:count]
    ]
    return _to_the_end(begun_well, score)


def raced(
    begun: Sequence[Hypothesis], beginnings: Beginnings
) -> tuple[Hypothesis, Fitted]:
    """Fit starts a little, and the better half of them further, until one is left.

    Successive halving [1]_: the same time is spent on all starts of a round together.
    The best start of each law stays for a round more: some laws take longer to come
    near.

    References
    ----------
    .. [1] K. Jamieson, A. Talwalkar, "Non-stochastic best arm identification and
       hyperparameter optimization", AISTATS 2016, 240-248.
    """
    running = [
        (item, Fitted(beginnings.cut(item.fitted.state), np.inf)) for item in begun
    ]
    evaluations = FEW
    while True:
        running = [
            (item, fitted(own.state, beginnings.score, evaluations))
            for item, own in running
        ]
        running.sort(key=lambda pair: pair[1].score)
        if len(running) == 1 or evaluations >= QUICK:
            return running[0]
        half = ceil(len(running) / 2)
        first = evaluations == FEW
        best_of_law = (
            {item.forms: item for item, _ in reversed(running)} if first else {}
        )
        running = [
            (item, own)
            for k, (item, own) in enumerate(running)
            if k < half or best_of_law.get(item.forms) is item
        ]
        evaluations = min(2 * evaluations, QUICK)


def fitted_each(begun: Iterable[Hypothesis], score: Score) -> list[Hypothesis]:
    """Fit all laws of all effects to the end, each from its likeliest start."""
    likely: dict[tuple[str, ...], Hypothesis] = {}
    for item in sorted(begun, key=lambda item: item.score):
        law = tuple(sorted(map(" ".join, zip(item.effects, item.forms, strict=True))))
        likely.setdefault(law, item)
    return _to_the_end(likely.values(), score)


def _to_the_end(begun: Iterable[Hypothesis], score: Score) -> list[Hypothesis]:
    """Fit hypotheses to the end; the least score first, none that runs away."""
    done = [
        replace(item, fitted=fitted_to_the_end(item.fitted.state, score))
        for item in begun
    ]
    kept = (
        item for item in done if np.isfinite(item.score) and not _vanishes(item, score)
    )
    return sorted(kept, key=lambda item: item.score)


def _vanishes(item: Hypothesis, score: Score) -> bool:
    """Tell whether an effect does as well without the number that makes it itself.

    A slider without its clearance is dry friction, which is tried as such.
    """
    state = item.fitted.state
    for added in state.added:
        name = effects()[added.effect].vanishing
        for place in added.blocks if name else ():
            if name not in state.chain[place].parameters():
                continue  # another law of the effect
            chain = list(state.chain)
            chain[place] = replace(chain[place], **{name: 0.0})
            if judged(state.with_chain(tuple(chain)), score) < item.score + SCALE:
                return True
    return False


def how_it_moves(state: ModelState, turns: bool) -> Moved:
    """Look how far, how fast and by what force a host moves on its records."""
    place = host_of(state)
    host: Any = state.chain[place]
    reach = speed = force = 0.0
    for record, z in zip(state.records, state.simulation.driving(place), strict=True):
        motion = host.motion(z, record.dt, ())
        q = motion.position
        reach = max(reach, float(np.ptp(q)) / 2)
        speed = max(speed, float(np.max(np.abs(motion.velocity))))
        driving = record.y if host.name == "impedance" else z
        force = max(force, float(np.max(np.abs(driving - np.mean(driving)))))
    tiny = 1.0 / HUGE
    step = min(record.dt for record in state.records)
    given = [record.u for record in state.records]
    shown = state.simulation.output
    anywhere = isinstance(host, Mechanism) and host.stiffness == 0.0
    return Moved(
        max(reach, tiny),
        max(speed, tiny),
        max(force, tiny),
        step,
        turns,
        anywhere,
        host.stiffness,
        *(max(float(np.max(np.abs(x))) for x in signals) for signals in (given, shown)),
    )
