"""Forces in a linear host: singles, then pairs, then three, all numbers refitted."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from hystbench.gap.effects import effects
from hystbench.gap.effects.law import Changed, Law
from hystbench.gap.fitting.edit_chain import without_effect
from hystbench.gap.fitting.least_squares import (
    EVALUATIONS,
    QUICK,
    Fitted,
    fitted,
    fitted_to_the_end,
    record_weights,
)
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.average_force import evened
from hystbench.gap.inside.beginnings import Beginnings
from hystbench.gap.inside.insert_law import (
    Offer,
    of_stores,
    with_changed,
    with_law,
)
from hystbench.gap.inside.joint import joints
from hystbench.gap.inside.race import FEW, a_little, further, raced
from hystbench.gap.progress import Say, silent
from hystbench.gap.thresholds import CERTAIN, FURTHER, PAYS, SCALE
from hystbench.record import FloatArray

SINGLES, PAIRS = 4, 2
"""Hypotheses of one force that go on to pairs, and of two that go on to threes: forces
that gain little alone may gain much together."""


def singles(
    host: Fitted,
    offer: Offer,
    score: Score,
    say: Say = silent,
    other: ModelState | None = None,
) -> list[Fitted]:
    """Try each force alone: the host without one first, then the least score.

    Forces are put into the host, or into another model that is as good without them.
    """
    begun = host if other is None else replace(host, state=other)
    return [host, *_one_more([begun], offer, score, SINGLES, host.score, say)]


def together(
    found: Sequence[Fitted],
    offer: Offer,
    score: Score,
    say: Say = silent,
    most: float = np.inf,
) -> list[Fitted]:
    """Go on from singles to pairs, and to threes.

    Forces that gain little alone may gain much together. But where one pays alone and
    no second one pays beside it, no three are tried, and none where two gain nothing.

    Parameters
    ----------
    found : sequence of Fitted
        The host alone, and with one force each.
    offer : callable
        Gives what may be put in.
    score : Score
    say : callable
    most : float
        How many forces, at most.

    Returns
    -------
    list of Fitted
        The host alone first; of each set of effects the best laws.
    """
    every, alone, carried = list(found), found[0].score, list(found[1:])
    for count, keep in ((2, PAIRS), (3, 1)):
        if (
            count > most
            or not may_gain(least(every), score)
            or _in_vain(every, carried)
        ):
            break
        if not of_stores(found[0]):
            carried = [item for item in carried if item.score < alone]
        carried = _one_more(carried, offer, score, keep, alone, say)
        every += carried
    best = least(every)
    if not of_stores(best):
        every += with_one_fewer(best, every, score)
        if _pays(best, every):
            every += _with_another(best, offer, score, alone, say)
    return best_of_each(every)


def least(found: Sequence[Fitted]) -> Fitted:
    """Give the hypothesis that scores least."""
    return min(found, key=lambda item: item.score)


def _pays(best: Fitted, every: Sequence[Fitted]) -> bool:
    """Tell whether the last of several effects is worth having."""
    fewer = least([x for x in every if len(x.effects) < max(len(best.effects), 1)])
    return fewer.score - best.score > FURTHER


def _in_vain(every: Sequence[Fitted], pairs: Sequence[Fitted]) -> bool:
    """Tell whether no two effects pay, nor a second one beside a first that does."""
    one = least([item for item in every if len(item.effects) < 2])
    tried = [item for item in pairs if len(item.effects) == 2]
    if not tried:
        return False
    alone, two = every[0].score, least(tried).score
    if not one.effects or alone - one.score <= PAYS:
        return alone - two <= PAYS
    return two > one.score - FURTHER


def with_one_fewer(best: Fitted, found: Sequence[Fitted], score: Score) -> list[Fitted]:
    """Take each effect of a hypothesis out, where the others together were not tried.

    An effect that stood for another one before that came may be needless beside it. The
    others have to come one after the other: one fewer of them was tried as well.
    """
    if len(best.effects) < 2:
        return []
    tried = {frozenset(item.effects) for item in found}
    left = []
    for number in range(len(best.effects)):
        others = tuple(x for k, x in enumerate(best.effects) if k != number)
        ways = (frozenset(others) - {one} for one in others)
        if frozenset(others) in tried or not any(way in tried for way in ways):
            continue
        left.append(Fitted(without_effect(best.state, number), np.inf))
    return _to_the_end(left, score)


def _with_another(
    best: Fitted, offer: Offer, score: Score, alone: float, say: Say
) -> list[Fitted]:
    """Put another effect in the place of each of several.

    One that came early may stand for another that is only seen beside the rest.
    """
    if len(best.effects) < 2:
        return []
    fewer = [without_effect(best.state, k) for k in range(len(best.effects))]
    carried = [fitted(state, score) for state in fewer]
    return _one_more(carried, offer, score, SINGLES, alone, say)


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


def _one_more(
    carried: Sequence[Fitted],
    offer: Offer,
    score: Score,
    keep: int,
    alone: float,
    say: Say,
) -> list[Fitted]:
    """Put one more force into each hypothesis; give the best, the least score first."""
    carried = [before for before in carried if may_gain(before, score)]
    if not carried:
        return []
    stores = any(of_stores(item) for item in carried)
    first = carried[0].state
    beginnings = (Beginnings.all_of if stores else Beginnings.of)(first, score)
    begun: list[Fitted] = []
    for before in carried:
        short = beginnings.cut(before.state)  # its tangents serve all effects
        for at, name, own in _offered(before, offer):
            if name not in before.effects:
                begun += starts(at, short, name, own, beginnings)
    if not begun:
        return []
    if stores:
        inside = [item for item in begun if item.state.added[-1].place == "inside"]
        around = [item for item in begun if item.state.added[-1].place != "inside"]
        best_first = fitted_each(inside, score)
        best_first += fitted_likely(around, beginnings, score, 1)
        best_first.sort(key=lambda item: item.score)
    else:
        best_first = fitted_likely(begun, beginnings, score, keep)
    for item in best_first[:3]:
        say(f"inside: {' + '.join(item.effects)}: gain {alone - item.score:.1f}")
    return best_first


def _offered(
    before: Fitted, offer: Offer
) -> Iterator[tuple[Fitted, str, Sequence[Law | Changed]]]:
    """Give what may be put into a hypothesis, a force wherever the joint may be."""
    for name, laws in offer(before).items():
        yield before, name, laws
    for state in joints(before.state):
        at = replace(before, state=state)
        for name, laws in offer(at).items():
            inside = [law for law in laws if getattr(law, "place", "") == "inside"]
            if inside:
                yield at, name, inside


def may_gain(item: Fitted, score: Score) -> bool:
    """Tell whether a further force could gain what it has to pay."""
    pays = FURTHER if item.effects else PAYS
    return item.score - score.least(item.state.freedom) > pays


def starts(
    before: Fitted,
    short: ModelState,
    effect: str,
    laws: Sequence[Law | Changed],
    beginnings: Beginnings,
) -> Iterator[Fitted]:
    """Put a further force inside, by each law and start, with the score to be expected.

    That is the score of the beginnings of the records, on which ``short`` is the model
    before. The residual there is explained by what the force does as it starts, as one
    column, by what each of its numbers does that starts at zero, which that column does
    not hold, and by what changes of all other numbers do, by least squares.
    """
    state = before.state
    tangents, weights = short.tangents, record_weights(short)
    tangents = tangents[:, np.isfinite(tangents).all(axis=0)]
    for law in laws:
        begun = (
            with_changed(state, effect, law)
            if isinstance(law, Changed)
            else with_law(state, effect, law)
        )
        if isinstance(law, Law) and not (law.stands_for or of_stores(before)):
            begun = evened(begun)
        own = beginnings.cut(begun)
        does = short.residual - own.residual
        starts_at_zero = of_zeros(own)
        if not (np.isfinite(does).all() and np.isfinite(starts_at_zero).all()):
            continue  # the law runs away, or would at the next step
        columns = np.column_stack([tangents, does, starts_at_zero])
        sizes = np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
        scaled = columns / sizes
        found, *_ = np.linalg.lstsq(
            scaled * weights[:, None], short.residual * weights, rcond=1e-8
        )
        rest = short.residual - scaled @ found
        expected = beginnings.score.of(rest, begun.freedom)
        yield Fitted(begun, expected)


def of_zeros(begun: ModelState) -> FloatArray:
    """Give the slopes by the numbers of what was put in last that start at zero."""
    own = begun.added[-1].blocks
    zeros = (x for x in begun.free if x.block in own and begun.value(x) == 0.0)
    return replace(begun, free=tuple(zeros)).tangents


def fitted_likely(
    begun: Iterable[Fitted], beginnings: Beginnings, score: Score, count: int
) -> list[Fitted]:
    """Fit the hypotheses that promise most: roughly first, the best of them to the end.

    Parameters
    ----------
    begun : iterable of Fitted
        With the scores to be expected.
    beginnings : Beginnings
        What they are fitted to roughly.
    score : Score
        Of the whole records.
    count : int
        How many, each by its best start, are fitted to the end. Twice as many are
        fitted roughly, and four times as many a little, each from twice as many starts
        and by all its laws: what a law promises where it starts says little of where it
        comes to.

    Returns
    -------
    list of Fitted
        Those that were fitted to the end, the least score first. Where the best one
        leaves what a further effect could gain, its other starts and the other laws of
        the rest were raced on whole records as well: a fit may end in one of several
        minima, and not all laws act at the beginning of a record.
    """
    likely: dict[frozenset[str], list[Fitted]] = {}
    for item in sorted(begun, key=lambda item: item.score):
        likely.setdefault(frozenset(item.effects), []).append(item)
    some = {
        effects: _of_each_law(own, 2 * count)
        for effects, own in list(likely.items())[: 4 * count]
    }
    tried = [a_little(own, beginnings) for own in some.values()]
    tried.sort(key=lambda running: running[0][1].score)
    rough = [
        raced(running, beginnings.score, FEW, QUICK) for running in tried[: 2 * count]
    ]
    rough.sort(key=lambda pair: pair[1].score)
    begun_well = []
    for item, own in rough[:count]:
        numbers = {k: own.state.value(free) for k, free in enumerate(item.state.free)}
        begun_well.append(replace(own, state=item.state.at(numbers)))
    done = _as_far_as_they_matter(begun_well, score)
    if done and may_gain(done[0], score):
        of_best, *others = (some[frozenset(item.effects)] for item in done)
        rest = [one for own in others for one in _of_each_law(own, 0)]
        nearest = [_on_the_whole(of_best, score, QUICK)]
        nearest += [_on_the_whole(rest, score, FEW)] if rest else []
        done += _to_the_end(nearest, score)
        done = sorted(best_of_each(done), key=lambda item: item.score)
    return done


def _on_the_whole(starts: Sequence[Fitted], score: Score, evaluations: int) -> Fitted:
    """Race starts on whole records; the first round takes so many evaluations."""
    begun = further([(item, item) for item in starts], score, evaluations)
    _, nearest = raced(begun, score, evaluations, EVALUATIONS)
    return nearest


def _as_far_as_they_matter(begun: Sequence[Fitted], score: Score) -> list[Fitted]:
    """Fit hypotheses to the end, or till it is beyond doubt that they are worse.

    That is so where the first leaves nothing that another effect could gain.
    """
    done = _to_the_end(begun[:1], score)
    others = list(begun[1:])
    if done and not may_gain(done[0], score):
        most = done[0].score + CERTAIN
        nearer = [fitted(item.state, score, QUICK) for item in others]
        others = [item for item in nearer if item.score < most]
        done += [item for item in nearer if most <= item.score < np.inf]
    return sorted([*done, *_to_the_end(others, score)], key=lambda item: item.score)


def _of_each_law(starts: Sequence[Fitted], count: int) -> list[Fitted]:
    """Give the likeliest starts, the likeliest of each law in any case."""
    firsts = list({item.forms: item for item in reversed(starts)}.values())
    others = [item for item in starts if not any(item is one for one in firsts)]
    return firsts + others[: max(count - len(firsts), 0)]


def fitted_each(begun: Iterable[Fitted], score: Score) -> list[Fitted]:
    """Fit all laws of all effects to the end, each from its likeliest start."""
    likely: dict[tuple[str, ...], Fitted] = {}
    for item in sorted(begun, key=lambda item: item.score):
        law = tuple(sorted(map(" ".join, zip(item.effects, item.forms, strict=True))))
        likely.setdefault(law, item)
    return _to_the_end(likely.values(), score)


def _to_the_end(begun: Iterable[Fitted], score: Score) -> list[Fitted]:
    """Fit hypotheses to the end; the least score first, none that runs away."""
    done = [fitted_to_the_end(item.state, score) for item in begun]
    kept = (
        item for item in done if np.isfinite(item.score) and not _vanishes(item, score)
    )
    return sorted(kept, key=lambda item: item.score)


def _vanishes(item: Fitted, score: Score) -> bool:
    """Tell whether an effect does as well without the number that makes it itself.

    A slider without its clearance is dry friction, which is tried as such. The other
    numbers may make up for what that number did.
    """
    state = item.state
    for added in state.added:
        without = effects()[added.effect].vanishing(added.form).items()
        for place, (name, value) in product(added.blocks, without):
            if name not in state.chain[place].parameters():
                continue  # another law of the effect
            chain = list(state.chain)
            chain[place] = replace(chain[place], **{name: value})
            others = (x for x in state.free if (x.block, x.parameter) != (place, name))
            bare = replace(state.with_chain(tuple(chain)), free=tuple(others))
            if fitted(bare, score, FEW).score < item.score + SCALE:
                return True
    return False
