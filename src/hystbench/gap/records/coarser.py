"""Long records with fewer samples, where their input moves slowly.

A smooth input that moves slowly beside the sampling rate is told by every second, third
or further sample as well: a model is simulated on these in a part of the time. Where
the output moves faster, the samples that are left are what they were. Of whole periods
the last ones tell what all do, from a start that repeats.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import ceil

from hystbench.blocks.held import Hold
from hystbench.gap.records.scored_samples import SAMPLES
from hystbench.record import FloatArray, Record
from hystbench.spectra import line_below, periodogram

POWER_BEYOND = 1e-4
"""Share of the input's power that may lie beyond what the coarse samples tell: a
hundredth of its rms."""
TOLD_BAND = 0.25
"""Share of the sampling rate up to which the curve through samples meets a sine
well."""
ENOUGH = 2 * SAMPLES
"""Samples that a record keeps, twice as many as are scored: it is simulated quickly."""


def coarser(records: tuple[Record, ...], hold: Hold) -> tuple[Record, ...]:
    """Give records of every n-th sample; the same ones where none can be spared.

    Parameters
    ----------
    records : tuple of Record
    hold : {"zero-order", "linear", "band-limited"}
        Only a band-limited input is told by fewer samples.
    """
    records = _last_periods(records)
    factor = sparing(records, hold)
    return records if factor == 1 else tuple(_every(x, factor) for x in records)


def sparing(records: Sequence[Record], hold: Hold) -> int:
    """Tell of how many samples one is enough.

    Whole periods stay whole, and of samples that were measured enough stay.
    """
    if hold != "band-limited":
        return 1
    fastest = max(_fastest(record.u) for record in records)
    fewest = min(len(record) for record in records)
    most = min(int(TOLD_BAND / max(fastest, TOLD_BAND / fewest)), fewest // ENOUGH)
    for factor in range(most, 1, -1):
        whole = all((item.period_samples or 0) % factor == 0 for item in records)
        counted = min(int(item.counted[::factor].sum()) for item in records)
        if whole and counted >= ENOUGH:
            return factor
    return 1


def _fastest(x: FloatArray) -> float:
    """Give the frequency, per sample, beyond which hardly any power lies."""
    power, frequency = periodogram(x, 1.0)
    return float(frequency[line_below(power, 1 - POWER_BEYOND)])


def _every(record: Record, factor: int) -> Record:
    """Keep every n-th sample."""
    period = record.period_samples
    return replace(
        record.cut(slice(None, None, factor)),
        period_samples=None if period is None else period // factor,
    )


def left_out(fewer: Sequence[Record], records: Sequence[Record]) -> bool:
    """Tell whether whole periods of records were left out, beside single samples."""
    return any(
        a.dt * (len(a) + 1) < b.dt * len(b) for a, b in zip(fewer, records, strict=True)
    )


def _last_periods(records: tuple[Record, ...]) -> tuple[Record, ...]:
    """Keep the last whole periods, as many as hold enough samples.

    All records begin as if their periods had come before, or none is cut.
    """
    kept = [
        ceil(ENOUGH / item.period_samples) * item.period_samples
        if item.period_samples and item.repeats
        else len(item)
        for item in records
    ]
    if any(count >= len(item) for count, item in zip(kept, records, strict=True)):
        return records
    return tuple(
        replace(item.cut(slice(-count, None)), period_samples=item.period_samples)
        for count, item in zip(kept, records, strict=True)
    )
