"""How well the numbers of a named effect are known, in the chain and beside it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri, stdtrit

from hystbench.gap.effects import effects
from hystbench.gap.effects.variant import Beside, Values
from hystbench.gap.fitting.added_signals import SMALL, beside_slope
from hystbench.gap.fitting.edit_chain import removable, without_effect
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.record import FloatArray

SAMPLES = 2000
"""Scored samples of a record: more than naming needs, as errors shrink with them."""
RANK = 1e-9
"""Directions that weigh less than this share are not told apart: they are left out."""
SHOWN = 1e-6
"""Share of the noise that a change of a whole number must move the output by to be
known at all."""
ROUNDING = 1e-12
"""Share of the output: what moves it by less is lost among its last digits."""
STRETCHES = 20
"""Stretches of a record, within which residuals may be correlated in any way."""
FEW = 4
"""Records that are needed to tell how much they differ."""

ALONE = 100.0
"""Times the variance of a number that it has without a record which tells it alone: ten
times the standard error."""

Errors = dict[str, float | list[float] | None]
"""Standard errors of a signal beside the chain, by parameter of its block."""


def standard_errors(state: ModelState, score: Score) -> FloatArray:
    """Estimate the standard error of each free number of a model.

    Weighted least squares with a covariance that is robust to correlation inside
    stretches of a record [1]_, or to what differs from record to record [2]_, where
    that is more; directions in which the hysteresis may be of the wrong shape count as
    fitted as far as the residual fills them.

    Parameters
    ----------
    state : ModelState
    score : Score
        Gives the records' weights and the directions.

    Returns
    -------
    ndarray, shape (free numbers,)
        NaN where the records say nothing of a number.

    References
    ----------
    .. [1] K.-Y. Liang, S. L. Zeger, "Longitudinal data analysis using generalized
       linear models", Biometrika 73 (1986) 13-22.
    .. [2] B. Efron, The Jackknife, the Bootstrap and Other Resampling Plans, SIAM,
       1982.
    """
    if not state.free:
        return np.zeros(0)
    columns = np.hstack([state.tangents, state.beside_columns])
    residual = _cleaned(state, columns)
    columns, residual = _beyond_shape(columns, residual, score)
    scale = np.sqrt(np.mean(columns**2, axis=0))
    # What the output shows of a number must be more than rounding.
    values = np.array([abs(state.value(free)) for free in state.free])
    own = scale[: len(values)]
    usable = scale > SHOWN * np.sqrt(score.floor)
    usable[: len(values)] = own * values > SHOWN * np.sqrt(score.floor)
    # One that is zero has no size: the step by which its slope was taken tells.
    output = np.sqrt(np.mean((state.measured - state.residual) ** 2))
    moved = own * np.abs(state.steps) > ROUNDING * output
    usable[: len(values)] |= (values == 0) & moved
    return _errors(columns, residual, usable, state, score.floor)[: len(state.free)]


def size_error(state: ModelState, square: float, number: int) -> float:
    """Estimate the standard error of an added effect's size, as a share of it.

    Of all its numbers together: they may stand in for each other, and none of them be
    known where what they do is. What it adds to the output is one column here, beside
    those of all other numbers. Directions of a wrong shape are not taken off: a gain or
    a static curve would have no size beside them, however alike all records show it.
    The record that moves the size most by being left out is not counted: it may be the
    only one that tells the effect from another, which is not to disagree with the rest.

    Parameters
    ----------
    state : ModelState
    square : float
        Mean square of what no model explains, in squared output units.
    number : int
        Place of the effect among those that were added.

    Returns
    -------
    float
        NaN where the records show nothing of it. So it is of a signal beside the chain,
        of which its own numbers tell, and of an effect that others stand on.
    """
    own = state.added[number].blocks
    if not own or not removable(state, number):
        return np.nan
    rest = [k for k, free in enumerate(state.free) if free.block not in own]
    without = without_effect(state, number).settled()
    columns = np.hstack(
        [
            (without.residual - state.residual)[:, None],
            state.tangents[:, rest],
            state.beside_columns,
        ]
    )
    residual = _cleaned(state, np.hstack([state.tangents, state.beside_columns]))
    usable = np.mean(columns**2, axis=0) > SHOWN**2 * square
    return float(_errors(columns, residual, usable, state, square, uncounted=1)[0])


def _cleaned(state: ModelState, columns: FloatArray) -> FloatArray:
    """Give the residual without what is solved for beside the free numbers."""
    beta = np.linalg.lstsq(columns, state.residual, rcond=1e-10)[0]
    beta[: len(state.free)] = 0.0
    return np.asarray(state.residual - columns @ beta)


def _beyond_shape(
    columns: FloatArray, residual: FloatArray, score: Score
) -> tuple[FloatArray, FloatArray]:
    """Take off what a wrong shape may do, as far as the residual fills it."""
    _, inside = score.split(residual)
    filled = float(inside @ inside) / max(len(inside), 1)
    share = max(0.0, 1.0 - score.floor / max(filled, score.floor))
    columns = columns - share * (score.directions @ (score.directions.T @ columns))
    return columns, residual - share * (score.directions @ inside)


def _errors(
    columns: FloatArray,
    residual: FloatArray,
    usable: NDArray[np.bool_],
    state: ModelState,
    square: float,
    uncounted: int = 0,
) -> FloatArray:
    """Give robust standard errors of the amplitudes of columns; NaN of those unused."""
    scale = np.sqrt(np.mean(columns[:, usable] ** 2, axis=0))
    pieces = _by_record(columns[:, usable] / scale, residual, state, square)
    between = between_records(pieces, uncounted)
    variance = np.maximum(np.diag(_between_stretches(pieces)), between)
    errors = np.full(len(usable), np.nan)
    errors[usable] = np.sqrt(np.maximum(variance, 0.0)) / scale
    return errors


class Pieces(NamedTuple):
    """What weighted least squares are made of, by record."""

    normals: list[FloatArray]  # shape (k, k): products of the columns
    pushes: list[FloatArray]  # shape (scored samples, k): of columns and residual


def _by_record(
    columns: FloatArray, residual: FloatArray, state: ModelState, square: float
) -> Pieces:
    """Give the pieces of least squares in which every record weighs by its residual."""
    normals, pushes = [], []
    for part in state.sample.slices:
        weight = 1.0 / max(float(np.mean(residual[part] ** 2)), square)
        weighted = weight * columns[part]
        normals.append(columns[part].T @ weighted)
        pushes.append(residual[part, None] * weighted)
    return Pieces(normals, pushes)


def _between_stretches(pieces: Pieces) -> FloatArray:
    """Covariance, shape (k, k), where the residuals of stretches are independent."""
    bread = np.linalg.pinv(sum(pieces.normals), rcond=RANK)
    totals = [
        stretch.sum(axis=0)
        for push in pieces.pushes
        for stretch in np.array_split(push, STRETCHES)
    ]
    meat = np.einsum("ij,ik->jk", totals, totals)
    meat *= len(totals) / max(len(totals) - len(bread), 1)
    return np.asarray(bread @ meat @ bread)


def between_records(pieces: Pieces, uncounted: int = 0) -> FloatArray:
    """Variances, shape (k,), by leaving out one record after the other (jackknife).

    What a model's form misses is alike within a record and differs between them. With
    few records the interval is as wide as Student's t distribution makes it. Of each
    number the records that move it most are left uncounted, as many as asked. So is one
    that tells the number alone: without it the others cannot disagree.
    """
    whole = np.sum(pieces.normals, axis=0)
    known = np.diag(np.linalg.pinv(whole, rcond=RANK))
    moved = np.empty((len(pieces.normals), len(whole)))
    for k, (normal, push) in enumerate(zip(*pieces, strict=True)):
        others = np.linalg.pinv(whole - normal, rcond=RANK)
        tells_alone = np.diag(others) > ALONE * known
        moved[k] = np.where(tells_alone, np.nan, others @ push.sum(axis=0))
    return np.array([_spread(own[np.isfinite(own)], uncounted) for own in moved.T])


def _spread(moved: FloatArray, uncounted: int) -> float:
    """Give the jackknife's variance of a number, by how far each record moves it."""
    count = len(moved) - uncounted
    if count < FEW:
        return 0.0
    near = np.argsort(np.abs(moved - np.median(moved)))[:count]
    # Quantiles of Student's t and of the normal distribution. Not by scipy.stats: to
    # load it takes each job of an effect longer than all else that it loads.
    wider = float(stdtrit(count - 1, 0.975) / ndtri(0.975))
    return (count - 1) * float(np.var(moved[near])) * wider**2


def beside_errors(state: ModelState, score: Score) -> list[Errors]:
    """Estimate the standard errors of the signals beside a chain.

    The covariance of all amplitudes, of what was searched (a frequency) and of the
    chain's free numbers together, robust to correlation inside stretches of a record
    as for the numbers of the chain; then by the first derivatives of what is told (a
    mean slope, the size of a tone) with respect to the amplitudes.

    Parameters
    ----------
    state : ModelState
    score : Score
        Gives the noise floor.

    Returns
    -------
    list of dict of str to float, list of float or None
        A mapping for each signal beside, by parameter of its block; None where the
        parameter is no number that was fitted.
    """
    if not state.beside:
        return []
    columns = np.hstack([state.tangents, state.beside_columns])
    found = np.linalg.lstsq(columns, state.residual, rcond=1e-10)[0]
    fitted = np.asarray(found, dtype=np.float64)
    residual = state.residual - columns @ fitted
    own = state.by_signal(np.arange(len(state.free), columns.shape[1]))
    amplitudes, places = [], []
    for (beside, values), rows in zip(state.beside, own, strict=True):
        amplitudes.append(fitted[rows.ravel()])
        searched = [
            beside_slope(
                state.records, state.sample, beside, values, key, amplitudes[-1]
            )
            for key in values
        ]
        behind = columns.shape[1] + np.arange(len(searched))
        places.append([*rows.ravel(), *behind])
        columns = np.column_stack([columns, *searched])
    scale = np.sqrt(np.mean(columns**2, axis=0))
    scale[scale == 0] = np.inf
    pieces = _by_record(columns / scale, residual, state, score.floor)
    covariance = _between_stretches(pieces) / np.outer(scale, scale)
    return [
        _told(state, *item, size, covariance[np.ix_(at, at)])
        for item, size, at in zip(state.beside, amplitudes, places, strict=True)
    ]


def _told(
    state: ModelState,
    beside: Beside,
    values: Values,
    amplitudes: FloatArray,
    covariance: FloatArray,
) -> Errors:
    """Carry a covariance over to the parameters that are told."""
    numbers = np.concatenate([amplitudes, [values[key] for key in values]])

    def described(at: FloatArray) -> dict[str, Any]:
        rows = at[: len(amplitudes)].reshape(len(state.records), -1)
        own = dict(zip(values, at[len(amplitudes) :].tolist(), strict=True))
        return effects()[beside.effect].describe(own, rows)

    size = max(float(np.abs(amplitudes).max()), 1e-300)
    now = described(numbers)
    slopes: dict[str, list[FloatArray]] = {key: [] for key in now}
    for k, value in enumerate(numbers):
        step = SMALL * (size if k < len(amplitudes) else max(abs(value), SMALL))
        moved = numbers.copy()
        moved[k] += step
        for key, item in described(moved).items():
            slopes[key].append((np.asarray(item) - np.asarray(now[key])) / step)
    return {key: _error(np.array(item), covariance) for key, item in slopes.items()}


def _error(slopes: FloatArray, covariance: FloatArray) -> float | list[float]:
    """Give the errors of one parameter, from its slopes, shape (k,) or (k, m)."""
    variance = np.einsum("i...,ij,j...->...", slopes, covariance, slopes)
    errors: float | list[float] = np.sqrt(np.maximum(variance, 0.0)).tolist()
    return errors


def on_more_samples(state: ModelState) -> ModelState:
    """Give a model with more of each record's samples scored."""
    sample = ScoredSamples.of(state.records, SAMPLES)
    return replace(state, sample=sample, correction=None).settled()
