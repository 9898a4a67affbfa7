"""Forces in a linear host: singles, then pairs, then three, all numbers refitted."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hystbench.blocks.force import Force
from hystbench.cores import each
from hystbench.gap.effects.law import Changed, Law
from hystbench.gap.fitting.edit_chain import without_effect
from hystbench.gap.fitting.fit_each import fit_each, write_fit
from hystbench.gap.fitting.in_stages import gentlest
from hystbench.gap.fitting.least_squares import (
    EVALUATIONS,
    Fitted,
    fitted,
    record_weights,
)
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.serialize import read_like
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.average_force import evened
from hystbench.gap.inside.beginnings import Beginnings
from hystbench.gap.inside.choose import best_of_each, least, may_gain, with_a_way
from hystbench.gap.inside.insert_law import (
    Laws,
    Offer,
    of_stores,
    with_changed,
    with_law,
)
from hystbench.gap.inside.joint import joints
from hystbench.gap.inside.likeliest import fitted_each, fitted_likely, to_the_end
from hystbench.gap.inside.other_laws import by_other_laws
from hystbench.gap.inside.other_names import of_one_name
from hystbench.gap.progress import Say, silent
from hystbench.gap.thresholds import FURTHER, PAYS
from hystbench.record import FloatArray

SINGLES, PAIRS = 4, 2
"""Hypotheses of one force that go on to pairs, and of two that go on to threes: forces
that gain little alone may gain much together."""


@dataclass(frozen=True)
class ForceSearch:
    """What forces are offered, and what they are judged by."""

    offer: Offer
    score: Score
    say: Say = silent

    def of(self, names: Collection[str]) -> ForceSearch:
        """Offer some effects only."""

        def some(fitted: Fitted) -> Laws:
            laws = self.offer(fitted)
            return {name: own for name, own in laws.items() if name in names}

        return replace(self, offer=some)

    def singles(self, host: Fitted, other: ModelState | None = None) -> list[Fitted]:
        """Try each force alone: the host without one first, then the least score.

        Forces are put into the host, or into another model that is as good without
        them.
        """
        begun = host if other is None else replace(host, state=other)
        return [host, *self.one_more([begun], SINGLES, host.score)]

    def together(self, found: Sequence[Fitted], most: float = np.inf) -> list[Fitted]:
        """Go on from singles to pairs, and to threes.

        Forces that gain little alone may gain much together. But where one pays alone
        and no second one pays beside it, no three are tried, and none where two gain
        nothing.

        Parameters
        ----------
        found : sequence of Fitted
            The host alone, and with one force each.
        most : float
            How many forces, at most.

        Returns
        -------
        list of Fitted
            The host alone first; of each set of effects the best laws.
        """
        every, went_on, asked = self._pairs_and_threes(found, most)
        score, alone, best = self.score, found[0].score, least(every)
        if not of_stores(best):
            every += with_one_fewer(best, every, score)
            paying = best_that_pays(every)
            every += with_one_fewer(paying, every, score, by_laws=True)
            every += self.with_another(paying, went_on, alone)
            last = best_that_pays(every)
            if not any(last is item for item in asked):
                every += by_other_laws(last, score)
        return with_a_way(best_of_each(every))

    def _pairs_and_threes(
        self, found: Sequence[Fitted], most: float
    ) -> tuple[list[Fitted], list[Fitted], list[Fitted]]:
        """Add pairs and threes to what was found.

        Given too is what a further force was put into, and what was tried by its other
        laws: the best of each round.
        """
        every, alone, carried = list(found), found[0].score, list(found[1:])
        went_on: list[Fitted] = []
        asked: list[Fitted] = []
        for count, keep in ((2, PAIRS), (3, 1)):
            if (
                count > most
                or not may_gain(least(every), self.score)
                or _in_vain(every, carried)
            ):
                break
            if not of_stores(found[0]):
                carried = [item for item in carried if item.score < alone]
            went_on += carried
            more = self.one_more(carried, keep, alone)
            asked.append(least([*more, found[0]]))
            more += by_other_laws(asked[-1], self.score)
            carried = sorted(best_of_each(more), key=lambda item: item.score)
            every += carried
        return every, went_on, asked

    def with_another(
        self, best: Fitted, went_on: Sequence[Fitted], alone: float
    ) -> list[Fitted]:
        """Put another effect in the place of each of several.

        One that came early may stand for another that is only seen beside the rest. Not
        where the search went on from the rest already.
        """
        if len(best.effects) < 2:
            return []
        fewer = [
            Fitted(without_effect(best.state, k), np.inf)
            for k in range(len(best.effects))
        ]
        known = {item.laws for item in went_on}
        carried = fit_each(
            lambda item: fitted(item.state, self.score),
            [x for x in fewer if x.laws not in known],
            EVALUATIONS,
        )
        return self.one_more(carried, PAIRS, alone)

    def one_more(
        self, carried: Sequence[Fitted], keep: int, alone: float
    ) -> list[Fitted]:
        """Put one more force into each hypothesis; give the best, by their scores.

        Nothing is put into one that diverges: it tells no sizes.
        """
        score = self.score
        carried = [
            before
            for before in carried
            if np.isfinite(before.score) and may_gain(before, score)
        ]
        if not carried:
            return []
        stores = any(of_stores(item) for item in carried)
        first = carried[0].state
        beginnings = (Beginnings.all_of if stores else Beginnings.of)(first, score)
        begun: list[Fitted] = []
        for before in carried:
            short = beginnings.cut(before.state)  # its tangents serve all effects
            begun += _each_begun(before, short, self.offer, beginnings)
        if not begun:
            return []
        gentle = () if first.added else gentlest(first)
        if stores:
            inside = [item for item in begun if item.state.added[-1].place == "inside"]
            around = [item for item in begun if item.state.added[-1].place != "inside"]
            best_first = fitted_each(inside, score, gentle)
            best_first += fitted_likely(around, beginnings, score, 1, gentle)
            best_first.sort(key=lambda item: item.score)
        else:
            best_first = fitted_likely(begun, beginnings, score, keep, gentle)
        for item in best_first[:3]:
            gain = alone - item.score
            self.say(f"inside: {' + '.join(item.effects)}: gain {gain:.1f}")
        return best_first


def best_that_pays(every: Sequence[Fitted]) -> Fitted:
    """Give the best hypothesis of which the last of several effects is worth having."""
    best = least(every)
    while len(best.effects) > 1:
        fewer = least([x for x in every if len(x.effects) < len(best.effects)])
        if fewer.score - best.score > FURTHER:
            break
        best = fewer
    return best


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


def with_one_fewer(
    best: Fitted,
    found: Sequence[Fitted],
    score: Score,
    by_laws: bool = False,
) -> list[Fitted]:
    """Take each effect of a hypothesis out, where the others together were not tried.

    An early effect may only have imitated a later one. The others are fitted only if a
    set with one effect fewer still was tried, so that a way leads to them
    (:func:`with_a_way`). With `by_laws` a set counts as tried only with the same laws.
    """
    if len(best.effects) < 2:
        return []
    effects = [{*item.effects} for item in found]
    laws = [item.laws for item in found]
    left = []
    for number in range(len(best.effects)):
        others = Fitted(without_effect(best.state, number), np.inf)
        ways = ({*others.effects} - {one} for one in others.effects)
        tried = others.laws in laws if by_laws else {*others.effects} in effects
        if not tried and any(way in effects for way in ways):
            left.append(others)
    return to_the_end(left, score)


def _each_begun(
    before: Fitted, short: ModelState, offer: Offer, beginnings: Beginnings
) -> list[Fitted]:
    """Put every further force that is offered into a hypothesis."""
    offered = [
        item for item in _offered(before, offer) if item[1] not in before.effects
    ]

    def begin(item: Offered) -> list[Fitted]:
        at, name, own = item
        return list(starts(at, short, name, own, beginnings))

    def write(begun: list[Fitted]) -> list[Any]:
        return list(map(write_fit, begun))

    def read(content: list[Any], item: Offered) -> list[Fitted]:
        return [Fitted(*own) for own in read_like(content, item[0].state)]

    if offered:
        _ = short.tangents  # once, and not on each core
    effort = len(short.sample)
    every = each(begin, offered, "starts", effort=effort, write=write, read=read)
    return [item for own in every for item in own]


Offered = tuple[Fitted, str, Sequence[Law | Changed]]
"""Where a force would be put in, its name, and its laws."""


def _offered(before: Fitted, offer: Offer) -> Iterator[Offered]:
    """Give what may be put into a hypothesis, a force wherever the joint may be."""
    for name, laws in of_one_name(offer(before)).items():
        yield before, name, laws
    for state in joints(before.state):
        at = replace(before, state=state)
        for name, laws in offer(at).items():
            inside = [law for law in laws if getattr(law, "place", "") == "inside"]
            if inside:
                yield at, name, inside


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
    not hold, and by what changes of all other numbers do, by least squares. Where the
    force has to be much weaker for that, it is begun so.
    """
    state = before.state
    tangents, weights = short.tangents, record_weights(short)
    tangents = tangents[:, np.isfinite(tangents).all(axis=0)]

    def begin(law: Law | Changed) -> tuple[Fitted, float] | None:
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
            return None  # the law runs away, or would at the next step
        columns = np.column_stack([tangents, does, starts_at_zero])
        sizes = np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
        scaled = columns / sizes
        found, *_ = np.linalg.lstsq(
            scaled * weights[:, None], short.residual * weights, rcond=1e-8
        )
        rest = short.residual - scaled @ found
        expected = beginnings.score.of(rest, begun.freedom)
        times = found[tangents.shape[1]] / sizes[tangents.shape[1]]
        return Fitted(begun, expected), float(times)

    for law in laws:
        found = begin(law)
        if found is None:
            continue
        item, times = found
        weaker = as_weak(law, times)
        again = None if weaker is None else begin(weaker)
        yield item if again is None or item.score < again[0].score else again[0]


TOO_STRONG = 1 / 3
"""Share of its strength that a force needs at most to be begun weaker."""
WEAKEST = 0.01


def as_weak(law: Law | Changed, share: float) -> Law | None:
    """Give a law whose force is weaker; None where that is no start.

    Its shape stays. One that begins too weak needs no other start: it grows into its
    place while a fit follows the motion. One that begins too strong has changed it.
    """
    if isinstance(law, Changed) or not isinstance(law.block, Force):
        return None
    if not 0.0 < share < TOO_STRONG:
        return None
    about = law.block.parameters()
    strengths = {
        name: max(share, WEAKEST) * getattr(law.block, name)
        for name in law.free
        if about[name].unit.startswith("U")
    }
    return replace(law, block=replace(law.block, **strengths)) if strengths else None


def of_zeros(begun: ModelState) -> FloatArray:
    """Give the slopes by the numbers of what was put in last that start at zero."""
    own = begun.added[-1].blocks
    zeros = (x for x in begun.free if x.block in own and begun.value(x) == 0.0)
    return replace(begun, free=tuple(zeros)).tangents
