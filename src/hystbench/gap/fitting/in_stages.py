"""A fit in stages: to some of the records first, and from there to all.

A mass on a hardening spring, or near a stop, may have two steady motions. A record that
jumps from one to the other jumps elsewhere when the numbers change a little, so that a
fit to it stops anywhere. Where the model before explains most, there is one motion.
These gentle records lead the numbers to where the others can be followed
(continuation [1]_). So may all but the one of which most is left. Or they hold the
numbers in a narrow valley, and that one leads on alone.

Most fits are not stuck. A fit from where some records led is therefore ended early if
it does not overtake the fit that it is to replace.

References
----------
.. [1] E. L. Allgower, K. Georg, "Introduction to Numerical Continuation Methods",
   SIAM, 2003, doi:10.1137/1.9780898719154.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hystbench.gap.fitting.least_squares import (
    QUICK,
    Fitted,
    fitted,
    fitted_to_the_end,
    judged,
)
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.thresholds import PAYS, SCALE

STILL = 1e-12
"""Share of the largest power of an output below which one stands still."""


def fitted_in_stages(
    begun: ModelState, score: Score, gentle: Sequence[int] = ()
) -> Fitted:
    """Fit a model to all records; where that leaves much, to gentle ones first as well.

    Parameters
    ----------
    begun : ModelState
    score : Score
        Of all records.
    gentle : sequence of int
        Places of records that lead from where the model begins.

    Returns
    -------
    Fitted
        The better of the fits.
    """
    best = fitted_to_the_end(begun, score)
    if not gentle or not _leaves_much(best, score):
        return best
    return min(best, _in_stages(begun, gentle, score, best), key=_score)


def led_out(found: Fitted, score: Score, least: float = np.inf) -> Fitted:
    """Fit a model that leaves much again, from fits without its worst record and to it.

    That is repeated while the score falls by what matters. What is behind another model
    has to come nearer by what an effect has to gain: some creep on for long.

    Parameters
    ----------
    found : Fitted
        A fit to all records.
    score : Score
        Of all records.
    least : float
        The best model's score.

    Returns
    -------
    Fitted
        The best of the fits.
    """
    count = len(found.state.records)
    while count > 1 and found.state.free and _leaves_much(found, score):
        worst = int(np.argmax(found.state.squares))
        others = tuple(k for k in range(count) if k != worst)
        best = found
        for some in (others, (worst,)):
            best = min(best, _in_stages(found.state, some, score, best), key=_score)
        gained = found.score - best.score
        if gained < SCALE:
            break
        found = best
        if gained < min(best.score - least, PAYS):
            break
    return found


def fitted_far(state: ModelState, score: Score) -> Fitted:
    """Fit a model whose numbers may have far to go, and lead it out of where it stops.

    Parameters
    ----------
    state : ModelState
    score : Score
        Of all records.
    """
    return led_out(fitted_to_the_end(state, score), score)


def gentlest(state: ModelState) -> tuple[int, ...]:
    """Give half of the records: those of whose output a model leaves the least share.

    None of a single record. Of an output that stands still any share is large.
    """
    outputs = [np.var(state.measured[part]) for part in state.sample.slices]
    shares = state.squares / np.maximum(outputs, STILL * np.max(outputs))
    order = np.argsort(shares, kind="stable").tolist()
    return tuple(sorted(order[: len(order) // 2]))


def _in_stages(
    state: ModelState, first: Sequence[int], score: Score, best: Fitted
) -> Fitted:
    """Fit to some records, and from there to all as long as that may overtake."""
    records = tuple(state.records[k] for k in first)
    some = replace(state, records=records, sample=ScoredSamples.of(records))
    near = fitted(some.settled(), Score.plain(some.sample, score.floor)).state
    whole = replace(near, records=state.records, sample=state.sample).settled()
    return _overtaking(Fitted(whole, judged(whole, score)), score, best)


def _overtaking(begun: Fitted, score: Score, best: Fitted) -> Fitted:
    """Fit a model on, to the end if it overtakes another fit.

    It is left where the score would not fall so far in as many evaluations more, or
    falls by what does not matter.
    """
    while begun.score >= best.score:
        before, begun = begun, fitted(begun.state, score, QUICK)
        behind = max(begun.score - best.score, SCALE)
        if not before.score - begun.score >= behind:  # nor if it has run away
            return begun
    return fitted_to_the_end(begun.state, score)


def _leaves_much(item: Fitted, score: Score) -> bool:
    return item.score - score.least(item.state.freedom) > PAYS


def _score(item: Fitted) -> float:
    return item.score
