"""The noise floor, and what else in a residual no model of the device explains.

White noise is sought in a spectrum by the median of its bins. Drift sits in the lowest
bins, mains in a few lone ones and a gap in the excited ones; the median passes them by.

The same input over and over brings the same output, period by period, from any plant
without a memory that outlasts a period; so does every error of a hysteresis. What still
differs between periods, beyond the noise, is none of that: heat, bad contacts, lost
words.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from hystbench.gap.records.black_box import black_box
from hystbench.gap.records.folds import SHORTEST
from hystbench.gap.records.lone_samples import far_off
from hystbench.gap.records.scored_samples import Compared, whole_periods
from hystbench.record import FloatArray, Record
from hystbench.spectra import line_below, periodogram

Method = Literal["repeats", "declared", "upper-bound"]

# The median of a chi-square variable of two degrees of freedom over its mean.
MEDIAN_OF_CHI_SQUARE = float(np.log(2))
# Below this share of the output's RMS nothing is called noise.
LEAST_NOISE = 1e-9
# Fewer bins than this give no median worth the name.
LEAST_BINS = 8


@dataclass(frozen=True)
class Floor:
    """The noise that no model explains."""

    rms: float
    """RMS of the white noise on the output, in the output's unit; above zero."""
    method: Method
    """Differences of periods; stated by the dataset; or the high, unexcited part of the
    residual's spectrum, as far as no black box predicts it. The last is a bound: what
    a gap leaves up there, and no black box knows, is taken for noise."""

    @property
    def square(self) -> float:
        """Mean square of the noise."""
        return self.rms**2


def noise_floor(compared: Sequence[Compared], declared: float | None = None) -> Floor:
    """Measure the white noise of the output.

    A declared floor is taken as it is. Otherwise the first half of a record's periods
    is subtracted from the second half: no model enters, and what the input causes
    cancels, gap included. Where no record holds two whole periods, the residual is
    read above the band that the input excites; and it is no more than a black box
    leaves on folds, which predicts the gap and no noise.

    Parameters
    ----------
    compared : sequence of Compared
        Sampling rates and lengths may differ.
    declared : float, optional
        ``noise_rms`` of the dataset, in the output's unit.

    Returns
    -------
    Floor

    Notes
    -----
    The estimate from the residual is called an upper bound always: nothing in one
    record tells noise from a gap that is broad and high. Of quantised output the floor
    is at least that of the quantisation, step / sqrt(12).
    """
    if declared is not None:
        return Floor(float(declared), "declared")
    repeated = [
        level for item in compared if (level := _from_repeats(item.record)) is not None
    ]
    # The noise is one: the median over the records shrugs off a spoilt one.
    if repeated:
        return Floor(float(np.median(repeated)), "repeats")
    bound = float(np.median([_from_residual(item) for item in compared]))
    if sum(len(item.record) for item in compared) < SHORTEST:
        return Floor(bound, "upper-bound")
    # What the input predicts is no noise: a broad gap reaches above the band too.
    predicted = black_box(compared, 0.0).left_on_folds
    least = min(_at_least(item.record.y, predicted) for item in compared)
    return Floor(min(bound, least), "upper-bound")


def _from_repeats(record: Record) -> float | None:
    """Read the noise off the difference of two runs of whole periods, if it has two."""
    period = record.period_samples
    periods = len(record) // period if period else 0
    if period is None or periods < 2 or periods * period < 4 * LEAST_BINS:
        return None
    # Two long runs, not many short ones: mains and the input's own lines stay narrow.
    n = periods // 2 * period
    difference = (record.y[-n:] - record.y[-2 * n : -n]) / np.sqrt(2)
    # A dropout or a spike is in all bins: no median of a spectrum shrugs it off.
    difference = difference[~far_off(difference)]
    power, _ = periodogram(difference, record.dt)
    return _at_least(record.y, np.sqrt(_median_level(power[2:])))


def _from_residual(item: Compared) -> float:
    """Read the noise off the residual above what the input excites."""
    record = item.record
    power, frequency = periodogram(item.residual, record.dt)
    edge = 0.0
    for cause in (record.u, item.simulated):
        caused, _ = periodogram(cause - np.mean(cause), record.dt)
        edge = max(edge, float(frequency[line_below(caused, 0.999)]))
    # Harmonics reach above the input's own band, but a quarter of the spectrum is kept.
    start = min(5 * edge, 0.75 * frequency[-1])
    high = power[(frequency >= start) & (frequency <= 0.98 * frequency[-1])]
    return _at_least(record.y, np.sqrt(_median_level(high)))


def _median_level(power: FloatArray) -> float:
    """Give the level of white noise whose periodogram has this median."""
    return float(np.median(power) / MEDIAN_OF_CHI_SQUARE) if len(power) else 0.0


def _at_least(y: FloatArray, rms: float) -> float:
    """Keep the floor above that of quantisation, and above zero."""
    scale = float(np.max(np.abs(y)))
    return float(max(rms, _step(y) / np.sqrt(12), LEAST_NOISE * scale, LEAST_NOISE**2))


def _step(y: FloatArray) -> float:
    """Give the step of quantised values: all differences are whole multiples of it."""
    values = np.unique(y)
    steps = np.diff(values)
    steps = steps[steps > LEAST_NOISE * float(values[-1] - values[0])]
    if not len(steps):
        return 0.0
    least = float(np.min(steps))
    multiples = steps / least
    whole = np.abs(multiples - np.round(multiples)) < 0.05
    return least if bool(np.all(whole)) else 0.0


LEAST_PERIODS = 3
"""One to settle, two to compare."""


def unrepeated(compared: Sequence[Compared], floor_rms: float) -> float | None:
    """Give the power of residuals that differs between periods, above the noise.

    The first whole period is left out: it starts from rest. The others are held against
    their mean.

    Parameters
    ----------
    compared : sequence of Compared
        A model's output beside each record.
    floor_rms : float
        RMS of the white noise, in the output's unit.

    Returns
    -------
    float or None
        In floors, averaged over the records with three whole periods or more; nothing
        without any.
    """
    powers = [
        _spread(item.residual, period) / floor_rms**2 - 1.0
        for item in compared
        if (period := item.record.period_samples)
        and len(item.record) // period >= LEAST_PERIODS
    ]
    return float(np.mean(powers)) if powers else None


def _spread(residual: FloatArray, period: int) -> float:
    """Give the variance of a place in the period over the settled periods."""
    return float(np.mean(np.var(whole_periods(residual, period), axis=0, ddof=1)))
