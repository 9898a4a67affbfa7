"""SINDy on the residual: sparse dynamics of what the base misses. Names nothing."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np

from hystbench.entrants.black_box import kept, residual
from hystbench.entrants.task import Given, Predict, read, write
from hystbench.record import FloatArray, Record

#: Degrees of the library, and smallest coefficients that are kept, for signals scaled
#: to a spread of one and columns of the library to a length of one.
DEGREES, THRESHOLDS = (1, 2), (0.05, 0.5)


def solve(dataset: Path, model: Path, out: Path) -> None:
    """Fit ``dr/dt = f(r, u, base)`` to the fit records; simulate it on the others.

    Of several degrees and thresholds the one is taken that comes nearest to the fit
    records when it is simulated; where none comes nearer than the base, the base is
    left as it is. Most of them run away.

    Parameters
    ----------
    dataset, model, out : Path
        As every solver's.

    References
    ----------
    .. [1] S. L. Brunton, J. L. Proctor, J. N. Kutz, "Discovering governing equations
       from data by sparse identification of nonlinear dynamical systems", PNAS 113
       (2016) 3932-3937.
    .. [2] K. Kaheman et al., "Learning discrepancy models from experimental data",
       arXiv:1909.08574, 2019.
    """
    import pysindy  # an optional package: hystbench[rivals]

    given = read(dataset, model)
    r = [residual(given, record) for record in given.fit]
    driven = [_driven(given, record) for record in given.fit]
    size = float(np.std(np.concatenate(r))) or 1.0
    spread = np.std(np.concatenate(driven), axis=0)
    found: list[tuple[FloatArray, FloatArray]] = []
    for degree in DEGREES:
        for threshold in THRESHOLDS:
            library = pysindy.PolynomialLibrary(degree=degree)
            fitted = pysindy.SINDy(
                optimizer=pysindy.STLSQ(threshold=threshold, normalize_columns=True),
                feature_library=library,
                differentiation_method=pysindy.SmoothedFiniteDifference(),
            )
            fitted.fit(
                [part[:, np.newaxis] / size for part in r],
                t=[record.time for record in given.fit],
                u=[part / spread for part in driven],
            )
            weights = np.asarray(fitted.coefficients())[0]
            found.append((weights, np.asarray(library.powers_)))

    def predict(record: Record, weights: FloatArray, powers: FloatArray) -> FloatArray:
        scaled = _driven(given, record) / spread
        missing = simulate(weights, powers, scaled, record.dt)
        return kept(given.base(record) + size * missing, record)

    def error(predict: Predict) -> float:
        return sum(
            float(np.sum((record.y - predict(record)) ** 2)) for record in given.fit
        )

    choices: list[Predict] = [
        given.base,
        *(partial(predict, weights=w, powers=p) for w, p in found),
    ]
    best = min(choices, key=error)
    write(given, [], "unnamed", "A black box names nothing.", best, out)


def _driven(given: Given, record: Record) -> FloatArray:
    return np.stack([record.u, given.base(record)], axis=1)


def simulate(
    weights: FloatArray, powers: FloatArray, driven: FloatArray, dt: float
) -> FloatArray:
    """Integrate ``dr/dt = sum_j w_j r^a_j u^b_j ...`` from rest, explicit midpoint.

    Parameters
    ----------
    weights : ndarray, shape (m,)
    powers : ndarray of int, shape (m, 1 + k)
        Of ``r`` and of each driving signal.
    driven : ndarray, shape (n, k)
    dt : float
        Sampling interval in seconds.

    Returns
    -------
    ndarray, shape (n,)
        NaN from where it ran away.
    """
    highest = int(powers[:, 0].max())
    # at each sample a polynomial in r, whose coefficients follow from what drives it
    terms = weights * np.prod(driven[:, np.newaxis, :] ** powers[:, 1:], axis=2)
    by_power = np.stack(
        [terms[:, powers[:, 0] == power].sum(axis=1) for power in range(highest + 1)],
        axis=1,
    )
    r, out = 0.0, np.full(len(driven), np.nan)
    for k in range(len(driven)):
        out[k] = r
        c = by_power[k]
        half = r + 0.5 * dt * _at(c, r)
        r += dt * _at(c, half)
        if not abs(r) < 1e6:
            break
    return out


def _at(coefficients: FloatArray, r: float) -> float:
    total = 0.0
    for c in coefficients[::-1]:
        total = total * r + c
    return float(total)
