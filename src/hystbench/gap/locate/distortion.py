"""Odd and even distortion: the residual of periodic records, line by line."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import fft

from hystbench.gap.locate.samples import Samples

# A line of the input holds at least this share of its strongest line's power.
EXCITED = 1e-6


@dataclass(frozen=True)
class Distortion:
    """Shares of the periodic records' residual power, which add to one.

    Parameters
    ----------
    excited, odd, even : float
        On the input's lines, on other odd and on other even harmonics of the period's
        lowest excited line.
    other : float
        Between the harmonics: noise, and what does not repeat.
    """

    excited: float
    odd: float
    even: float
    other: float


def take_distortion(samples: Samples) -> Distortion | None:
    """Sort the residual's power by harmonics, over records with at least two periods.

    Harmonics are those of the lowest excited line; an input of odd lines alone then
    shows even distortion where it has no power (Pintelon and Schoukens 2012, ch. 4).

    Returns
    -------
    Distortion or None
        None where no record holds two whole periods.
    """
    powers = np.zeros(4)
    for item in samples.compared:
        period = item.record.period_samples
        if not period or len(item.record) < 2 * period:
            continue
        count = len(item.record) // period
        residual = item.residual[-count * period :]
        u = item.record.u[-count * period :]
        power = np.abs(fft.rfft(residual - residual.mean())) ** 2
        cause = np.abs(fft.rfft(u - u.mean())) ** 2
        if not np.any(cause > 0):
            continue
        excited = np.flatnonzero(cause > EXCITED * np.max(cause))
        lowest = int(excited[0])
        bins = np.arange(len(power))
        harmonic, between = np.divmod(bins, lowest)
        kind = np.where(between == 0, np.where(harmonic % 2 == 1, 1, 2), 3)
        kind[excited] = 0
        kind[0] = 3
        # Over its length, so that a record weighs by its samples' power.
        powers += np.bincount(kind, power, 4) / len(residual)
    total = float(np.sum(powers))
    if total <= 0:
        return None
    excited_share, odd, even, other = (float(value) for value in powers / total)
    return Distortion(excited_share, odd, even, other)
