"""How well the numbers of a named effect are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hystbench.gap.sample import Sample
from hystbench.gap.score import Score
from hystbench.gap.state import State
from hystbench.record import FloatArray

SAMPLES = 2000
"""Scored samples of a record: more than naming needs, as errors shrink with them."""
RANK = 1e-9
"""Directions that weigh less than this share are not told apart: they are left out."""
SHOWN = 1e-6
"""Of the noise: what a change of a whole number must do to be known at all."""
STRETCHES = 20
"""Of a record, within which residuals may be correlated in any way."""


def standard_errors(state: State, score: Score) -> FloatArray:
    """Estimate the standard error of each free number of a model.

    Weighted least squares with a covariance that is robust to correlation inside
    stretches of a record [1]_; directions in which the hysteresis may be of the wrong
    shape count as fitted as far as the residual fills them.

    Parameters
    ----------
    state : State
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
    """
    if not state.free:
        return np.zeros(0)
    residual = state.residual
    columns = np.hstack([state.tangents, state.beside_columns])
    beta = np.linalg.lstsq(columns, residual, rcond=1e-10)[0]
    beta[: len(state.free)] = 0.0
    residual = residual - columns @ beta
    _, inside = score.split(residual)
    filled = float(inside @ inside) / max(len(inside), 1)
    share = max(0.0, 1.0 - score.floor / max(filled, score.floor))
    columns = columns - share * (score.directions @ (score.directions.T @ columns))
    residual = residual - share * (score.directions @ inside)
    scale = np.sqrt(np.mean(columns**2, axis=0))
    # What the output shows of a number must be more than rounding.
    values = np.array([abs(state.value(free)) for free in state.free])
    shown = scale.copy()
    shown[: len(values)] *= np.maximum(values, 1e-12)
    usable = shown > SHOWN * np.sqrt(score.floor)
    columns = columns[:, usable] / scale[usable]
    weights = np.empty(len(residual))
    for part in state.sample.slices:
        weights[part] = 1.0 / max(float(np.mean(residual[part] ** 2)), score.floor)
    bread = np.linalg.pinv(columns.T @ (weights[:, None] * columns), rcond=RANK)
    meat = np.zeros_like(bread)
    clusters = 0
    for part in state.sample.slices:
        pushed = (weights * residual)[part, None] * columns[part]
        for stretch in np.array_split(pushed, STRETCHES):
            total = stretch.sum(axis=0)
            meat += np.outer(total, total)
            clusters += 1
    k = columns.shape[1]
    meat *= clusters / max(clusters - k, 1)
    variance = np.diag(bread @ meat @ bread)
    errors = np.full(len(usable), np.nan)
    errors[usable] = np.sqrt(np.maximum(variance, 0.0)) / scale[usable]
    found: FloatArray = errors[: len(state.free)]
    return found


def on_more_samples(state: State) -> State:
    """Give a model with more of each record's samples scored."""
    sample = Sample.of(state.records, SAMPLES)
    return replace(state, sample=sample, correction=None).settled()
