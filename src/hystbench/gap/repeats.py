"""What is left and does not repeat with a periodic input.

The same input over and over brings the same output, period by period, from any plant
without a memory that outlasts a period; so does every error of a model's hysteresis.
What still differs between periods, beyond the noise, is none of that: heat, bad
contacts, lost words.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hystbench.gap.periods import settled
from hystbench.gap.records.residual import Compared
from hystbench.record import FloatArray

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
    return float(np.mean(np.var(settled(residual, period), axis=0, ddof=1)))
