"""SINDy on the residual: sparse equations for what the base misses. Names nothing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from itertools import product

import numpy as np

from hystbench.entrants.black_box import best, features, kept, residual
from hystbench.entrants.task import Answer, Given, Predict
from hystbench.record import FloatArray, Record

#: Degrees of the libraries, and smallest coefficients that are kept, for signals scaled
#: to a spread of one and time to a rate of one.
DYNAMIC_DEGREES, STATIC_DEGREES, THRESHOLDS = (1, 2), (1, 2, 3), (0.02, 0.2)


def answer(given: Given) -> Answer:
    """Fit ``dr/dt = f(r, x)`` and ``r = f(x)``, and take what predicts best.

    ``r`` is the residual, ``x`` the input and the base's output with their rates, and
    ``f`` a sparse polynomial. Noise in the derivative of ``r`` biases its dynamics, so
    that an effect without memory is better found without them.

    References
    ----------
    .. [1] S. L. Brunton, J. L. Proctor, J. N. Kutz, "Discovering governing equations
       from data by sparse identification of nonlinear dynamical systems", PNAS 113
       (2016) 3932-3937.
    .. [2] K. Kaheman et al., "Learning discrepancy models from experimental data",
       arXiv:1909.08574, 2019.
    """
    ways = [
        *(
            partial(_dynamics, given, *way)
            for way in product(DYNAMIC_DEGREES, THRESHOLDS)
        ),
        *(partial(_static, given, *way) for way in product(STATIC_DEGREES, THRESHOLDS)),
    ]
    return Answer(best(given, ways))


def _dynamics(
    given: Given, degree: int, threshold: float, records: Sequence[Record]
) -> Predict:
    import pysindy  # an optional package: make rivals

    r, x, size, spread = _learned(given, records)
    differentiate = pysindy.SmoothedFiniteDifference()
    rates = [
        differentiate(part, record.time)
        for part, record in zip(r, records, strict=True)
    ]
    rate = float(np.std(np.concatenate(rates))) or 1.0
    library = pysindy.PolynomialLibrary(degree=degree)
    found = pysindy.SINDy(
        optimizer=pysindy.STLSQ(threshold=threshold),
        feature_library=library,
        differentiation_method=differentiate,
    )
    found.fit(r, t=[rate * record.time for record in records], u=x)
    weights = np.asarray(found.coefficients())[0]
    powers = np.asarray(library.powers_)

    def predict(record: Record) -> FloatArray:
        driven = _driving(given, record) / spread
        missing = size * simulate(weights, powers, driven, rate * record.dt)
        return kept(given.base(record) + missing, record)

    return predict


def _static(
    given: Given, degree: int, threshold: float, records: Sequence[Record]
) -> Predict:
    import pysindy  # an optional package: make rivals

    r, x, size, spread = _learned(given, records)
    library = pysindy.PolynomialLibrary(degree=degree)
    terms = np.asarray(library.fit_transform(np.concatenate(x)))
    found = pysindy.STLSQ(threshold=threshold).fit(terms, np.concatenate(r))
    weights = np.asarray(found.coef_)[0]

    def predict(record: Record) -> FloatArray:
        driven = _driving(given, record) / spread
        missing = size * np.asarray(library.transform(driven)) @ weights
        return kept(given.base(record) + missing, record)

    return predict


def _learned(
    given: Given, records: Sequence[Record]
) -> tuple[list[FloatArray], list[FloatArray], float, FloatArray]:
    """Scale residual and what drives it; give the scales too."""
    r = [residual(given, record)[:, np.newaxis] for record in records]
    x = [_driving(given, record) for record in records]
    size = float(np.std(np.concatenate(r))) or 1.0
    spread = np.std(np.concatenate(x), axis=0)
    spread = np.where(spread > 0, spread, 1.0)
    return [part / size for part in r], [part / spread for part in x], size, spread


def _driving(given: Given, record: Record) -> FloatArray:
    """Input and base with their rates, without time."""
    return features(given, record)[:, :4]


def simulate(
    weights: FloatArray, powers: FloatArray, driven: FloatArray, dt: float
) -> FloatArray:
    """Integrate ``dr/dt = sum_j w_j r^a_j u^b_j ...`` from rest.

    By the exponential Rosenbrock-Euler method, with what drives it held over a step:
    exact where it is linear in ``r``, so that fast dynamics stay bounded where an
    explicit method would not.

    Parameters
    ----------
    weights : ndarray, shape (m,)
    powers : ndarray of int, shape (m, 1 + k)
        Of ``r`` and of each driving signal.
    driven : ndarray, shape (n, k)
    dt : float
        Sampling interval, in the unit of time of the weights.

    Returns
    -------
    ndarray, shape (n,)
        NaN from where it ran away.

    References
    ----------
    .. [1] M. Hochbruck, A. Ostermann, "Exponential integrators", Acta Numerica 19
       (2010) 209-286, section 2.4.
    """
    highest = int(powers[:, 0].max())
    # at each sample a polynomial in r, whose coefficients follow from what drives it
    terms = weights * np.prod(driven[:, np.newaxis, :] ** powers[:, 1:], axis=2)
    by_power = np.stack(
        [terms[:, powers[:, 0] == power].sum(axis=1) for power in range(highest + 1)],
        axis=1,
    ).tolist()
    r, out = 0.0, np.full(len(driven), np.nan)
    for k, coefficients in enumerate(by_power):
        out[k] = r
        value = slope = 0.0
        for c in reversed(coefficients):
            slope = slope * r + value
            value = value * r + c
        growth = dt * slope
        if growth > 50:
            break
        r += dt * value * (math.expm1(growth) / growth if growth else 1.0)
        if not abs(r) < 1e6:
            break
    return out
