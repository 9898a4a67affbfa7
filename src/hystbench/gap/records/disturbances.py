"""What in a residual no model of the device explains.

Samples that stand alone, far off from the others: dropouts, spikes. And what does not
repeat with a periodic input. The same input over and over brings the same output,
period by period, from any plant without a memory that outlasts a period; so does every
error of a model's hysteresis. What still differs between periods, beyond the noise, is
none of that: heat, bad contacts, lost words.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hystbench.gap.records.residual import Compared, whole_periods
from hystbench.record import FloatArray

FAR = 8.0
"""Robust standard deviations: of normal noise no sample is so far off."""
TO_SIGMA = 1.4826
"""Standard deviation of normal noise over its median absolute deviation."""


def lone_share(residuals: Sequence[FloatArray]) -> float:
    """Give the share of the power of residuals that stands in samples far off.

    Each record is held against its own median absolute deviation; one more than half
    of which is a single value says nothing.

    Parameters
    ----------
    residuals : sequence of ndarray, shape (n,)
    """
    far = whole = 0.0
    for residual in residuals:
        about = residual - np.median(residual)
        usual = TO_SIGMA * float(np.median(np.abs(about)))
        squares = about**2
        whole += float(squares.sum())
        if usual > 0:
            far += float(squares[np.abs(about) > FAR * usual].sum())
    return far / whole if whole > 0 else 0.0


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
