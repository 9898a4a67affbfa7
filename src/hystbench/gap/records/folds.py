"""Folds of the fit records: which samples are fitted and which only judge.

A simulation always runs freely over a whole record; only the scoring is masked. Samples
that were not measured neither fit nor judge.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hystbench.record import Mask, Record

#: With so many records whole ones are held out; with fewer, blocks of each.
WHOLE_RECORDS = 3
#: Never more folds: each of them is a refit of every candidate.
MOST_FOLDS = 5
#: Contiguous blocks of a record, where there are few records.
BLOCKS = 4
#: Part of a block on each side of it that neither fits nor judges.
GUARD_SHARE = 0.1
#: Samples of a record that can be cut into blocks: with fewer than 25 one says nothing.
SHORTEST = 25 * BLOCKS


@dataclass(frozen=True)
class Fold:
    """What fits and what judges, a mask over the samples of each record."""

    train: tuple[Mask, ...]
    validation: tuple[Mask, ...]
    """One mask a record, in the records' order, shape (n,) each. No sample is in both;
    the samples of a guard gap are in neither, nor are interpolated ones."""


def make_folds(
    records: Sequence[Record], whole: bool | None = None
) -> tuple[Fold, ...]:
    """Divide the fit records into folds.

    Three records or more: a fold is a group of whole records, one of at most five.
    Records are dealt to the groups in the order of their rate, so that a fold asks
    for rates between those it was fitted to and not for all of the fastest ones.
    Fewer records: each is cut into four contiguous blocks, of whole periods where it
    has as many, and a fold holds back one block of each record. A guard gap of a tenth
    of a block keeps what a block remembers of its neighbours out of the fit.

    Every measured sample behind a lead judges in exactly one fold. A block in which
    nothing was measured is no fold.

    Parameters
    ----------
    records : sequence of Record
        Those with ``use: fit``, of at least ``SHORTEST`` samples each.
    whole : bool, optional
        Whether whole records are held out. By default where there are three; False
        asks the easier question, whether a model interpolates within each record: of
        sines of one frequency a record, a free model cannot guess the next frequency.

    Returns
    -------
    tuple of Fold
    """
    if whole is None:
        whole = len(records) >= WHOLE_RECORDS
    folds = _by_record(records) if whole else _by_block(records)
    counted = (
        Fold(_measured(fold.train, records), _measured(fold.validation, records))
        for fold in folds
    )
    return tuple(
        fold for fold in counted if any(mask.any() for mask in fold.validation)
    )


def _measured(masks: Sequence[Mask], records: Sequence[Record]) -> tuple[Mask, ...]:
    return tuple(
        mask & record.counted for mask, record in zip(masks, records, strict=True)
    )


def _by_record(records: Sequence[Record]) -> tuple[Fold, ...]:
    count = min(len(records), MOST_FOLDS)
    group = np.empty(len(records), dtype=int)
    group[np.argsort([record.rate for record in records], kind="stable")] = (
        np.arange(len(records)) % count
    )
    held = [
        tuple(
            np.full(len(record), group[place] == fold)
            for place, record in enumerate(records)
        )
        for fold in range(count)
    ]
    return tuple(Fold(tuple(~mask for mask in masks), masks) for masks in held)


def _by_block(records: Sequence[Record]) -> tuple[Fold, ...]:
    folds = []
    for block in range(BLOCKS):
        train, validation = [], []
        for record in records:
            edges = _edges(record)
            first, last = edges[block], edges[block + 1]
            guard = max(1, round(GUARD_SHARE * (last - first)))
            sample = np.arange(len(record))
            validation.append((sample >= first) & (sample < last))
            train.append((sample < first - guard) | (sample >= last + guard))
        folds.append(Fold(tuple(train), tuple(validation)))
    return tuple(folds)


def _edges(record: Record) -> list[int]:
    """Where blocks begin, behind the lead of a record, and the end."""
    unit, count = record.period_samples or 1, len(record) - record.lead
    if count // unit < BLOCKS:
        unit = 1
    starts = [unit * (count // unit * block // BLOCKS) for block in range(BLOCKS)]
    return [record.lead + start for start in (*starts, count)]
