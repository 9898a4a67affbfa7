"""Candidates judged on records that did not fit them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hystbench.blocks.calls import CallsUsedUp
from hystbench.gap.fitting.cross_validation import gain_held_back
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.naming.rounds import Candidate
from hystbench.gap.thresholds import CERTAIN, PARAMETER, PAYS


def first_on_folds(
    candidates: Sequence[Candidate], before: ModelState, score: Score
) -> list[Candidate]:
    """Judge candidates on folds, best first, while one may be the first.

    A candidate can only lose there. So one that scores worse than the best judged so
    far, beyond doubt, need not be judged.
    """
    best, found = np.inf, []
    for item in candidates:
        if item.held_back is None and item.score < best + CERTAIN:
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
        held = gain_held_back(before, item.state, score)
    except CallsUsedUp as error:
        return Candidate(item.effect, item.place, declined=str(error))
    charge = PARAMETER * (item.state.freedom - before.freedom)
    lost = max(item.gain - (held - charge), 0.0)
    return replace(item, score=item.score + lost, gain=item.gain - lost, held_back=held)
