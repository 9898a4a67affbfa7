"""Records that begin in a steady motion: the period that came before is put back.

A hysteresis remembers the turns of its input, and a model begins each record at rest.
A record whose output repeats from its first period on was cut out of a longer one, in
which the same period had come before.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from hystbench.gap.thresholds import ABOVE_NOISE, MOST
from hystbench.record import FloatArray, Record

ROUNDED = 1e-6
"""Share of the largest value that is no difference: files have six digits or more."""
SIGNALS = ("u", "y", "simulated", "interpolated")
"""What a record has of each sample."""


def with_pasts(records: Sequence[Record]) -> tuple[Record, ...]:
    """Put a period before records that begin in a steady motion.

    Models run over it, from rest; scores leave it out. The other records, and those
    that have a lead, stay as they are.

    Parameters
    ----------
    records : sequence of Record
    """
    return tuple(
        _with_past(record) if not record.lead and is_steady(record) else record
        for record in records
    )


def is_steady(record: Record) -> bool:
    """Tell whether a record's first period is as those behind it.

    That is so where both input and output differ between the first two periods by no
    more than noise: by what differs between later ones, or, where there are but two,
    by what differs from sample to sample and no more in the first half than in the
    second. A trend is none: what goes on from period to period, as creep does, may have
    begun with the record.
    """
    period = record.period_samples
    if period is None or len(record) < 2 * period or record.decay_s is not None:
        return False
    count = len(record) // period
    measured = record.counted[: count * period].reshape(count, period).all(axis=0)
    if np.count_nonzero(measured) < 2:
        return False
    signals = (record.u, record.y)
    return all(
        _alike(signal[: count * period].reshape(count, period)[:, measured])
        for signal in signals
    )


def _alike(periods: FloatArray) -> bool:
    """Tell whether the first of periods, shape (count, samples), is as the second."""
    first, *later = (a - b for a, b in pairwise(periods))
    whole = np.mean(first**2)
    if whole <= (ROUNDED * np.max(np.abs(periods))) ** 2:
        return True
    if later:
        noise = np.mean(np.square(later))
    else:
        early, late = (np.mean(x**2) for x in np.array_split(first, 2))
        if early > (1 + ABOVE_NOISE) * late:
            return False
        # White noise differs twice as much between neighbours as it has power.
        noise = np.mean(np.diff(first) ** 2) / 2
    line = np.polynomial.legendre.legfit(np.linspace(-1, 1, len(first)), first, 1)
    trend = line[0] ** 2 + line[1] ** 2 / 3
    return bool(whole <= (1 + ABOVE_NOISE) * noise and trend <= MOST * whole)


def _with_past(record: Record) -> Record:
    return put_before(record.cut(slice(record.period_samples)), record)


def put_before(before: Record, record: Record) -> Record:
    """Put what came before in front of a record: models run over it, unscored."""
    signals: dict[str, Any] = {}
    for name in SIGNALS:
        pair = [getattr(item, name) for item in (before, record)]
        if any(x is not None for x in pair):
            signals[name] = np.concatenate(
                [
                    np.zeros(len(item), dtype=bool) if x is None else x
                    for item, x in zip((before, record), pair, strict=True)
                ]
            )
    return replace(record, **signals, lead=len(before), past=len(before))
