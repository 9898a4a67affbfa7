"""Candidates of one ranking held against each other, once each was fitted by itself."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from hystbench.blocks.calls import CallsUsedUp
from hystbench.gap.effects import effects
from hystbench.gap.fitting.cross_validation import gain_on_folds
from hystbench.gap.fitting.model_score import directions_of, score_of
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.naming.loops import is_a_curve
from hystbench.gap.naming.rounds import Candidate, in_order
from hystbench.gap.thresholds import AS_GOOD, CERTAIN, LOOSE, PARAMETER, PAYS, SCALE

A_CURVE = "has no loop, and a curve of few numbers leaves as little"


def first_on_folds(
    candidates: Sequence[Candidate], before: ModelState, score: Score
) -> list[Candidate]:
    """Judge candidates on folds, best first, while one may be the first.

    A candidate can only lose there. So one that scores worse than the best judged so
    far, beyond doubt, need not be judged.
    """
    best, found = np.inf, []
    for item in candidates:
        if item.gain_on_folds is None and item.score < best + CERTAIN:
            item = on_folds(item, before, score)
        if item.state is not None and not item.declined:
            best = min(best, item.score)
        found.append(item)
    return found


def on_folds(item: Candidate, before: ModelState, score: Score) -> Candidate:
    """Judge a finalist that pays on records that did not fit it.

    What it gained on all records, charged for its freedom, it can only lose: a fold
    that fits better than all of them together shows no merit. What it gains there is
    charged as well: of two that both leave noise alone, the one of fewer numbers leads.
    """
    if item.state is None or item.gain < PAYS:
        return item
    try:
        held = gain_on_folds(before, item.state, score)
    except CallsUsedUp as error:
        return item.but(str(error))
    charge = PARAMETER * (item.state.freedom - before.freedom)
    lost = max(item.gain - (held - charge), 0.0)
    return replace(item.dearer(lost), gain_on_folds=held)


def by_all_their_laws(candidates: Sequence[Candidate]) -> list[Candidate]:
    """Sum the evidence of all laws of each effect.

    Each law is as likely as the others before anything was measured. So an effect is
    charged for its laws that do not fit. If all of them fit equally well, nothing is
    charged. With ``s`` the scores of ``n`` laws and their places, the effect's score is
    raised by ``-SCALE log(sum(exp((min(s) - s) / SCALE)) / n)``.
    """

    def summed(item: Candidate) -> Candidate:
        if item.state is None or not item.variants:
            return item
        scores = np.array([x.score for x in item.variants])
        likely = np.exp((scores.min() - scores) / SCALE)
        return item.dearer(-SCALE * float(np.log(np.mean(likely))))

    return in_order(summed(item) for item in candidates)


def beyond_simpler_laws(
    candidates: Sequence[Candidate], before: ModelState, score: Score
) -> list[Candidate]:
    """Charge forms that bend to much, where a simpler law takes nearly as much.

    The simpler law has no more numbers, gains at least `PAYS` and scores worse.

    - A free form is a path or a correction of the hysteresis. It is charged if the
      simpler law leaves less than `LOOSE` of the gap more.
    - An offset form is a law with an offset of the output. A biased field has one if
      the sensor was set to zero with the bias on. It is charged if the simpler law
      leaves less than `AS_GOOD` of the gap more.

    The charge is `CERTAIN`: both forms may stand for what the simulation misses. A
    hysteresis without a loop declines beside a simpler law that leaves less than
    `AS_GOOD` of the gap more: many plays bend to any curve.
    """
    floor = score.floor
    gap = before.power(floor)

    def charged(item: Candidate) -> Candidate:
        curve = item.state is not None and is_a_curve(item.state, item.effect)
        more = AS_GOOD if curve else _may_leave_more(item)
        if item.state is None or not more:
            return item
        for other in candidates:
            if other.state is None or other.gain < PAYS or other.score <= item.score:
                continue
            simpler = item.state.freedom >= other.state.freedom
            if simpler and item.state.share(other.state, floor, gap) < more:
                return item.but(A_CURVE) if curve else item.dearer(CERTAIN)
        return item

    return in_order(charged(item) for item in candidates)


def _may_leave_more(item: Candidate) -> float:
    """Give the share of the gap that a simpler law may leave more; none for most."""
    effect = effects()[item.effect]
    if item.form in effect.free_forms:
        return LOOSE
    return AS_GOOD if item.form in effect.offsets else 0.0


def beside_their_own_shapes(
    candidates: Sequence[Candidate],
    alike: Sequence[str],
    before: ModelState,
    square: float,
) -> list[Candidate]:
    """Compare candidates that score alike beside what a wrong shape does in each.

    The base's hysteresis gets another input behind a lag, and its output goes through
    what follows it: a wrong shape of it looks different with the effect than without.
    The best keeps its score; the others are as far behind it as these scores say,
    above that of noise, as the directions are not as many.

    Parameters
    ----------
    candidates : sequence of Candidate
    alike : sequence of str
        Effects of those that are compared.
    before : ModelState
        Without them; where it has no hysteresis, nothing is to be compared.
    square : float
        Mean square of the noise.
    """
    if len(alike) < 2 or not before.wrong_shape.shape[1]:
        return list(candidates)
    own = {
        item.effect: above_noise_of_its_own(item.state, before, square)
        for item in candidates
        if item.effect in alike and item.state is not None
    }
    if not own:
        return list(candidates)
    best = next(x for x in candidates if x.effect == min(own, key=lambda k: own[k]))
    behind = {name: value - own[best.effect] for name, value in own.items()}
    return in_order(
        replace(
            item,
            score=best.score + behind[item.effect],
            gain=best.gain - behind[item.effect],
        )
        if item.effect in behind
        else item
        for item in candidates
    )


def above_noise_of_its_own(
    state: ModelState, before: ModelState, square: float
) -> float:
    """Score a model above noise, beside what a wrong shape of its own could do.

    Its numbers stay charged; effects that were there before may be of another form.
    """
    own = Score(state.sample, directions_of(state.wrong_shape, before), square)
    return score_of(state, own) - own.least()


def simplest_of_a_tie(
    candidates: Sequence[Candidate], exact: Collection[str], needs: float
) -> list[Candidate]:
    """Put what has the fewest numbers first, of those that cannot be told apart.

    Scores stay as they are: a name that leads for that alone has a confidence of less
    than a half.

    Parameters
    ----------
    candidates : sequence of Candidate
        What scores least, first.
    exact : collection of str
        Effects that were simulated exactly; others cannot lead.
    needs : float
        What an effect has to gain to be taken.
    """
    tied = [
        item
        for item in candidates
        if item.state is not None
        and item.effect in exact
        and item.gain >= needs
        and item.score < candidates[0].score + SCALE
    ]
    if len(tied) < 2:
        return list(candidates)
    first = min(tied, key=lambda item: (_freedom(item), item.score))
    return [first, *(item for item in candidates if item is not first)]


def _freedom(item: Candidate) -> float:
    return np.inf if item.state is None else item.state.freedom
