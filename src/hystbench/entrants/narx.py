"""Polynomial NARX on the residual, by forward regression. Names nothing."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from itertools import product

import numpy as np

from hystbench.entrants.black_box import best, kept, residual
from hystbench.entrants.task import Answer, Given, Predict
from hystbench.record import FloatArray, Record

DEGREES, LAG, TERMS = (1, 2, 3), 2, 20
#: With the residual's own past, and without it (sysidentpy's names): the case of NARX
#: that cannot run away.
KINDS = ("NARMAX", "NFIR")
#: Samples of each record that it is fitted to.
SAMPLES = 1500


def answer(given: Given) -> Answer:
    """Fit the residual from its own past, the input and the base; let it run free.

    Lags are samples, whatever the record's rate, as is usual. Of several degrees, with
    and without the residual's past, the one is taken that predicts best.

    References
    ----------
    .. [1] S. A. Billings, Nonlinear System Identification: NARMAX Methods in the Time,
       Frequency, and Spatio-Temporal Domains, Wiley, 2013.
    """
    ways = [partial(_learn, given, *way) for way in product(KINDS, DEGREES)]
    return Answer(best(given, ways))


def _learn(given: Given, kind: str, degree: int, records: Sequence[Record]) -> Predict:
    # an optional package: make rivals
    from sysidentpy.basis_function import Polynomial
    from sysidentpy.model_structure_selection import FROLS
    from sysidentpy.parameter_estimation import LeastSquares

    r = np.concatenate([residual(given, record)[:SAMPLES] for record in records])
    x = np.concatenate([_driven(given, record)[:SAMPLES] for record in records])
    size, spread = float(np.std(r)) or 1.0, np.std(x, axis=0)
    found = FROLS(
        model_type=kind,
        order_selection=True,
        n_info_values=TERMS,
        info_criteria="bic",
        ylag=LAG,
        xlag=[list(range(1, LAG + 1))] * x.shape[1],
        basis_function=Polynomial(degree=degree),
        estimator=LeastSquares(),
    )
    found.fit(X=x / spread, y=r[:, np.newaxis] / size)

    def predict(record: Record) -> FloatArray:
        start = np.zeros((LAG, 1))
        with np.errstate(all="ignore"):
            ran = found.predict(X=_driven(given, record) / spread, y=start)
        return kept(given.base(record) + size * ran[:, 0], record)

    return predict


def _driven(given: Given, record: Record) -> FloatArray:
    return np.stack([record.u, given.base(record)], axis=1)
