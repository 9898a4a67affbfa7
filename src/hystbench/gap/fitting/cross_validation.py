"""Cross-validation: what an effect gains on records that did not fit it."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hystbench.cores import each
from hystbench.gap.fitting.refit import refit
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.serialize import remembered_of, state_key
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.records.folds import make_folds
from hystbench.gap.thresholds import SCALE
from hystbench.record import FloatArray

ROUNDS = 1
"""Rounds of least squares on a fold: the fit to all records is near."""

RUNS_AWAY = -1e6
"""What a model gains, at worst, that has no bounded output on folds."""

Used = tuple[NDArray[np.bool_], ...]
"""Which of each record's scored samples count."""


class _Fold(NamedTuple):
    train: Score
    """Score on the samples that are fitted."""
    held: Used
    """What judges."""
    outside: FloatArray
    """Terms of the score there of the model without the effect, by record."""


def gain_on_folds(
    before: ModelState, after: ModelState, score: Score, in_blocks: bool | None = None
) -> float:
    """Tell by how much an effect lowers the score of records that did not fit it.

    The fit records are dealt out in folds; where there are fewer than three, blocks of
    them are, with a guard gap. So they are where the effect shows in one record alone,
    as a stop does that no other comes to: these cannot foretell it. On each fold the
    model with the effect is refitted to the rest; what reshaping could do is fitted to
    all of it, with the effect and without alike. A signal beside the chain has
    amplitudes of its own in every record, which no other record knows: they are solved
    for in each, so that folds tell little of it. The model without the effect stays as
    it was fitted to all records, to its advantage.

    Parameters
    ----------
    before, after : ModelState
        Models without and with the effect, on the same records.
    score : Score
    in_blocks : bool, optional
        Whether folds are blocks, where that was found out: so that two models that are
        compared are judged on the same folds.

    Returns
    -------
    float
        Over all folds, so of every record once; above zero where the effect pays.
    """
    return remembered_of(
        after,
        lambda: ["held back", *state_key(before), score.digest, in_blocks],
        lambda: _gain(before, after, score, in_blocks),
    )


def _gain(
    before: ModelState, after: ModelState, score: Score, in_blocks: bool | None
) -> float:
    if in_blocks is None:
        in_blocks = shows_in_one_record(before, after, score)
    folds, inside = _folds(before, score, False if in_blocks else None)

    def gained(fold: _Fold) -> float:
        fitted, _ = refit(after, fold.train, ROUNDS)
        with np.errstate(over="ignore", invalid="ignore"):  # of one that runs away
            rest, within = _split(fitted, score)
            outside = _terms(rest, score, fold.held)
        return float(np.sum(fold.outside - outside)) + (inside - within) / len(folds)

    return max(RUNS_AWAY, sum(each(gained, folds, "folds")))


def shows_in_one_record(before: ModelState, after: ModelState, score: Score) -> bool:
    """Tell whether an effect gains in one record and changes no other."""
    was, now = (_terms_of_all(model, score) for model in (before, after))
    (shows,) = np.nonzero(np.abs(was - now) > SCALE)
    return len(shows) == 1 and bool(was[shows[0]] > now[shows[0]])


@lru_cache(maxsize=2)
def _terms_of_all(model: ModelState, score: Score) -> FloatArray:
    """Give the terms of whole records; a round asks for one model again and again."""
    every = tuple(np.ones(len(x), dtype=bool) for x in model.sample.positions)
    return _terms(_split(model, score)[0], score, every)


@lru_cache(maxsize=2)
def _folds(
    before: ModelState, score: Score, whole: bool | None
) -> tuple[tuple[_Fold, ...], float]:
    """Give the folds, and the term of the directions without the effect.

    All effects of a round share them.
    """
    rest, inside = _split(before, score)
    found = []
    for fold in make_folds(before.records, whole):
        train, held = (
            tuple(
                mask[places]
                for mask, places in zip(masks, before.sample.positions, strict=True)
            )
            for masks in (fold.train, fold.validation)
        )
        outside = _terms(rest, score, held)
        found.append(_Fold(replace(score, used=train), held, outside))
    return tuple(found), inside


def _split(model: ModelState, score: Score) -> tuple[FloatArray, float]:
    """Give what the directions leave of a residual, and their term of the score."""
    columns = model.beside_columns
    amplitudes = score.amplitudes(model.residual, columns).values
    rest, inside = score.split(model.residual - columns @ amplitudes)
    return rest, score.of_directions(float(inside @ inside))


def _terms(rest: FloatArray, score: Score, held: Used) -> FloatArray:
    """Give the terms of the score of held-back samples, by record."""
    terms = []
    parts = zip(score.sample.slices, held, score.weights, strict=True)
    for part, used, weight in parts:
        if used.any():
            square = max(float(np.mean(rest[part][used] ** 2)), score.floor)
            terms.append(weight * used.mean() * np.log(square))
    return np.array(terms)
