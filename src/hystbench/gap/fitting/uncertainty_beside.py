"""How well the numbers of what lies beside the chain are known."""

from __future__ import annotations

from typing import Any

import numpy as np

from hystbench.gap.effects import effects
from hystbench.gap.effects.variant import Beside, Values
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import SMALL, ModelState, beside_slope
from hystbench.gap.fitting.uncertainty import between_stretches, by_record
from hystbench.record import FloatArray

Errors = dict[str, float | list[float] | None]


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
            beside_slope(state, beside, values, key, amplitudes[-1]) for key in values
        ]
        behind = columns.shape[1] + np.arange(len(searched))
        places.append([*rows.ravel(), *behind])
        columns = np.column_stack([columns, *searched])
    covariance = _covariance(columns, residual, state, score.floor)
    return [
        _told(state, *item, size, covariance[np.ix_(at, at)])
        for item, size, at in zip(state.beside, amplitudes, places, strict=True)
    ]


def _covariance(
    columns: FloatArray, residual: FloatArray, state: ModelState, floor: float
) -> FloatArray:
    """Covariance of weighted least squares, robust inside stretches of a record."""
    scale = np.sqrt(np.mean(columns**2, axis=0))
    scale[scale == 0] = np.inf
    pieces = by_record(columns / scale, residual, state, floor)
    return np.asarray(between_stretches(pieces) / np.outer(scale, scale))


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
