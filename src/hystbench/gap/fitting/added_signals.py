"""Signals beside a chain, which the input does not explain: their shapes on records."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hystbench.gap.effects.variant import Beside, Values
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.record import FloatArray, Record

SMALL = 1e-6
"""Change of a number of the shapes beside, as a share, by which a slope is taken."""


def beside_columns(
    records: Sequence[Record], sample: ScoredSamples, beside: Beside, values: Values
) -> FloatArray:
    """Scored samples of the shapes beside, one block of columns a record."""
    parts = []
    for record, where, positions in zip(
        records, sample.slices, sample.positions, strict=True
    ):
        own = beside.columns(record, values, beside.order, positions)
        full = np.zeros((len(sample), own.shape[1]))
        full[where] = own
        parts.append(full)
    return np.hstack(parts)


def beside_slope(
    records: Sequence[Record],
    sample: ScoredSamples,
    beside: Beside,
    values: Values,
    key: str,
    amplitudes: FloatArray,
) -> FloatArray:
    """How the output changes with a number of the shapes beside."""
    step = SMALL * max(abs(values[key]), SMALL)
    ends = [
        beside_columns(
            records, sample, beside, {**values, key: values[key] + sign * step}
        )
        for sign in (1, -1)
    ]
    return np.asarray((ends[0] - ends[1]) @ amplitudes / (2 * step))
