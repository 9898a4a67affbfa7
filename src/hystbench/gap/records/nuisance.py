"""What is new in every record: a path of drift, the phase of the mains.

No fit to other records can know it. It is estimated on a record's first 30 %, which is
then not scored.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from hystbench.gap.thresholds import LOOSE
from hystbench.metrics import rms
from hystbench.record import FloatArray, Mask, Record

#: Part of a hold-out record that estimates what is new in it.
FIRST = 0.3
#: Samples of a record that has such a part: with fewer than ten it estimates nothing.
SHORTEST = math.ceil(10 / FIRST)
#: Degree of a path that may be carried on.
HIGHEST_DEGREE = 2
#: Periods, counted by crossings of the mean, of which two whole ones have three.
REPEATING_PERIODS = 1.5
#: Of the mean rate, for half of a record, to be a hold.
HOLD_RATE = 0.1
#: Regressors of what is new in a record: shape (n, m) from the record; m may be 0.
Nuisance = Callable[[Record], FloatArray]


def without_nuisance(
    residual: FloatArray, regressors: FloatArray, estimating: Mask
) -> FloatArray:
    """Take off what is new in a record, estimated on samples that are not scored.

    Least squares of the residual on the regressors over the samples ``estimating``;
    directions that those samples do not show stay at zero.

    Parameters
    ----------
    residual : ndarray, shape (n,)
    regressors : ndarray, shape (n, m)
    estimating : ndarray of bool, shape (n,)

    Returns
    -------
    ndarray, shape (n,)
    """
    if regressors.shape[1] == 0:
        return residual
    scale = np.sqrt(np.mean(np.square(regressors), axis=0))
    columns = regressors / np.where(scale > 0, scale, 1.0)
    weights, *_ = np.linalg.lstsq(columns[estimating], residual[estimating], rcond=1e-6)
    return np.asarray(residual - columns @ weights)


def left_over(
    record: Record, simulated: FloatArray, nuisance: Nuisance | None
) -> tuple[FloatArray, Mask]:
    """Residual without what is new in the record, and the samples that are scored.

    Samples that were not measured neither estimate nor are scored. What is not known of
    the first sample is estimated on the whole record, as is usual where a window begins
    in the middle of a motion.

    Parameters
    ----------
    record : Record
    simulated : ndarray, shape (n,)
    nuisance : callable or None
        Gives the regressors; without it every measured sample is scored.

    Returns
    -------
    residual : ndarray, shape (n,)
    scored : ndarray of bool, shape (n,)
    """
    residual = record.y - simulated
    if record.of_start.shape[1]:
        everything = record.counted
        residual = without_nuisance(residual, record.of_start, everything)
    if nuisance is None:
        return residual, record.counted
    first = round(FIRST * (len(record) - record.past))
    late = np.arange(len(record)) >= record.past + first
    rest = without_nuisance(residual, nuisance(record), ~late & record.counted)
    return rest, late & record.counted


def left_rms(
    records: Sequence[Record],
    simulated: Sequence[FloatArray | None],
    nuisance: Nuisance | None = None,
) -> float | None:
    """RMS residual of a model over all records together.

    Parameters
    ----------
    records : sequence of Record
    simulated : sequence of ndarray or None
        Its output of each record; None where it runs away.
    nuisance : callable, optional
        As for :func:`left_over`.

    Returns
    -------
    float or None
        None where the model runs away on a record.
    """
    left = [
        residual[scored]
        for record, output in zip(records, simulated, strict=True)
        if output is not None
        for residual, scored in [left_over(record, output, nuisance)]
    ]
    return rms(*left) if len(left) == len(records) else None


def path_and_mains(degree: int | None, mains_hz: Sequence[float] = ()) -> Nuisance:
    """Regressors of a polynomial in time and of tones of unknown phase.

    Parameters
    ----------
    degree : int or None
        Of the polynomial: 0 is an offset. None where a record has no path of its own.
    mains_hz : sequence of float
        Frequencies of the tones.
    """

    def regressors(record: Record) -> FloatArray:
        time = record.time
        span = max(float(time[-1]), record.dt)
        count = 0 if degree is None else degree + 1
        columns = [(time / span) ** k for k in range(count)]
        for frequency in mains_hz:
            angle = 2 * np.pi * frequency * time
            columns += [np.cos(angle), np.sin(angle)]
        return np.column_stack(columns) if columns else np.zeros((len(time), 0))

    return regressors


def degree_that_carries_on(
    records: Sequence[Record],
    simulated: Sequence[FloatArray],
    mains_hz: Sequence[float] = (),
) -> int:
    """Choose by how much of a path the first part of a record tells the rest.

    A steady drift goes on along its slope; of one that wanders, a slope would magnify
    what the first part happened to do. Which of them it is, the fit records show.

    Parameters
    ----------
    records : sequence of Record
        Fit records.
    simulated : sequence of ndarray, shape (n,) each
        Outputs of the model with its effects.
    mains_hz : sequence of float
        Frequencies of tones that are estimated as well.

    Returns
    -------
    int
        0 to 2; a higher one must leave clearly less.
    """
    best, least = 0, np.inf
    for degree in range(HIGHEST_DEGREE + 1):
        size = left_rms(records, simulated, path_and_mains(degree, mains_hz))
        assert size is not None  # noqa: S101  (on fit records no model runs away)
        if size**2 < (1 - LOOSE) * least**2:
            best, least = degree, size
    return best


def shows_a_path(record: Record) -> bool:
    """Tell whether a path of its own would show beside what the input does.

    Within one period of an input that never rests, a path can stand in for any error
    of the loop: nothing comes twice. A second period, or a hold, tells them apart.
    """
    moves = np.abs(np.diff(record.u))
    holds = float(np.median(moves)) < HOLD_RATE * float(np.mean(moves))
    return holds or periods_of_input(record) >= REPEATING_PERIODS


def periods_of_input(record: Record) -> float:
    """Count the input's periods in a record by how often it crosses its mean."""
    above = record.u > float(np.mean(record.u))
    return float(np.count_nonzero(above[1:] != above[:-1])) / 2
