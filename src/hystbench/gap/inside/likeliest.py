"""The likeliest hypotheses of forces: raced roughly, and fitted to the end."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from hystbench.gap.effects import effects
from hystbench.gap.fitting.fit_each import fit_each
from hystbench.gap.fitting.in_stages import fitted_in_stages, led_out
from hystbench.gap.fitting.least_squares import (
    EVALUATIONS,
    QUICK,
    Fitted,
    fitted,
)
from hystbench.gap.fitting.score import Score
from hystbench.gap.inside.beginnings import Beginnings
from hystbench.gap.inside.choose import best_of_each, may_gain
from hystbench.gap.inside.race import FEW, a_little, further, raced
from hystbench.gap.thresholds import CERTAIN, SCALE


def fitted_likely(
    begun: Iterable[Fitted],
    beginnings: Beginnings,
    score: Score,
    count: int,
    gentle: Sequence[int] = (),
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
        and by all its laws: the score at a start says little of the score after a fit.
    gentle : sequence of int
        Records that lead a fit which leaves much: :func:`fitted_in_stages`. What they
        led to is then led out of where it stopped.

    Returns
    -------
    list of Fitted
        Those that were fitted to the end, the least score first. Where the best one
        leaves what a further effect could gain, its other starts and the other laws of
        the rest were raced on whole records as well: a fit may end in one of several
        minima, and not all laws act at the beginning of a record. Where records
        repeat, the rough fit has seen whole periods.
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
    done = _as_far_as_they_matter(begun_well, score, gentle)
    if done and beginnings.cut_short and may_gain(done[0], score):
        of_best, *others = (some[frozenset(item.effects)] for item in done)
        rest = [one for own in others for one in _of_each_law(own, 0)]
        nearest = [_on_the_whole(of_best, score, QUICK)]
        nearest += [_on_the_whole(rest, score, FEW)] if rest else []
        done += to_the_end(nearest, score, gentle)
        done = best_of_each(done)
    if gentle and done:
        least = min(item.score for item in done)
        done = fit_each(lambda item: _led_out(item, score, least), done, EVALUATIONS)
    return sorted(done, key=lambda item: item.score)


def _on_the_whole(starts: Sequence[Fitted], score: Score, evaluations: int) -> Fitted:
    """Race starts on whole records; the first round takes so many evaluations."""
    begun = further([(item, item) for item in starts], score, evaluations)
    _, nearest = raced(begun, score, evaluations, EVALUATIONS)
    return nearest


def _as_far_as_they_matter(
    begun: Sequence[Fitted], score: Score, gentle: Sequence[int]
) -> list[Fitted]:
    """Fit hypotheses to the end, or till it is beyond doubt that they are worse.

    That is so where the first leaves nothing that another effect could gain.
    """
    done = to_the_end(begun[:1], score, gentle)
    others = list(begun[1:])
    if done and not may_gain(done[0], score):
        most = done[0].score + CERTAIN
        nearer = fit_each(
            lambda item: fitted(item.state, score, QUICK),
            others,
            QUICK,
        )
        others = [item for item in nearer if item.score < most]
        done += [item for item in nearer if most <= item.score < np.inf]
    done += to_the_end(others, score, gentle)
    return sorted(done, key=lambda item: item.score)


def _of_each_law(starts: Sequence[Fitted], count: int) -> list[Fitted]:
    """Give the likeliest starts, the likeliest of each law in any case."""
    firsts = list({item.forms: item for item in reversed(starts)}.values())
    others = [item for item in starts if not any(item is one for one in firsts)]
    return firsts + others[: max(count - len(firsts), 0)]


def fitted_each(
    begun: Iterable[Fitted], score: Score, gentle: Sequence[int] = ()
) -> list[Fitted]:
    """Fit all laws of all effects to the end, each from its likeliest start."""
    likely: dict[frozenset[tuple[str, str]], Fitted] = {}
    for item in sorted(begun, key=lambda item: item.score):
        likely.setdefault(item.laws, item)
    return to_the_end(likely.values(), score, gentle)


def to_the_end(
    begun: Iterable[Fitted], score: Score, gentle: Sequence[int] = ()
) -> list[Fitted]:
    """Fit hypotheses to the end; the least score first, none that runs away.

    Those that leave what another effect could gain are led by the gentle records too.
    """
    done = fit_each(
        lambda item: fitted_in_stages(item.state, score, gentle),
        list(begun),
        EVALUATIONS,
    )
    return sorted(_that_are_themselves(done, score), key=lambda item: item.score)


def _led_out(item: Fitted, score: Score, least: float) -> Fitted:
    """Lead a fit out of where it stopped; not to where it is another effect."""
    led = led_out(item, score, least)
    return next(_that_are_themselves([led], score), item) if led is not item else item


def _that_are_themselves(items: Iterable[Fitted], score: Score) -> Iterator[Fitted]:
    """Give those that do not run away, and have what makes their effects those."""
    for item in items:
        if np.isfinite(item.score) and not _vanishes(item, score):
            yield item


def _vanishes(item: Fitted, score: Score) -> bool:
    """Tell whether an effect does as well without the number that makes it itself.

    A slider without its clearance is dry friction, which is tried as such. The other
    numbers may make up for what that number did.
    """
    state = item.state
    for added in state.added:
        effect = effects()[added.effect]
        for place in added.blocks:
            for block, name in effect.vanishing(added.form, state.chain[place]):
                free = (
                    x for x in state.free if (x.block, x.parameter) != (place, name)
                )
                bare = replace(state.with_blocks({place: block}), free=tuple(free))
                if fitted(bare, score, FEW).score < item.score + SCALE:
                    return True
    return False
