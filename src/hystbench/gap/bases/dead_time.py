"""Records of a device that answers after a dead time, with their input as late.

Many poles and zeros imitate a dead time, and beside them it no longer shows. So a
linear model is also looked for behind it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hystbench.blocks.input_delay import InputDelay
from hystbench.gap.bases.orders import HIGHEST_WITH_MODES
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.thresholds import AS_GOOD
from hystbench.record import FloatArray, Record

ORDER = HIGHEST_WITH_MODES
"""Of the model in differences: as many poles as a linear base may have."""
LONGEST = 100
"""Sampling intervals: a dead time that is tried is shorter."""
SHORTEST = 2
"""Of the shortest: a sample is how records are stamped."""
ROWS = 100_000
"""Samples that are multiplied at a time."""


def behind_a_dead_time(evidence: Evidence) -> tuple[Evidence, float] | None:
    """Give the fit records with their input as late as the output answers it.

    A model in differences of order 20, of output and input, predicts each sample of the
    output from those before it. Its input is taken later and later [1]_. The dead time
    is the shortest with which it predicts as well as with any.

    Returns
    -------
    tuple or None
        The records, and the dead time in seconds; None where there is none of two
        samples, or records are sampled at different rates.

    References
    ----------
    .. [1] S. Bjorklund, L. Ljung, "A review of time-delay estimation techniques",
       Proceedings of the 42nd IEEE Conference on Decision and Control (2003) 2502-2507.
    """
    records = [x for x in evidence.fit if len(x) > 2 * (LONGEST + ORDER)]
    steps = {record.dt for record in evidence.fit}
    if len(steps) != 1 or not records:
        return None
    gram = np.sum([_products(record) for record in records], axis=0)
    errors = np.array([_error(gram, late) for late in range(LONGEST)])
    errors = np.maximum(errors, 0.0)  # below that is rounding
    as_good = np.flatnonzero(errors <= (1 + AS_GOOD) * errors.min())
    late = int(as_good[0])
    if late < SHORTEST:
        return None
    (step,) = steps
    block = InputDelay.by(late * step, evidence.input_hold)
    fit = tuple(replace(x, u=block.simulate(x.u, x.u, x.dt)) for x in evidence.fit)
    return replace(evidence, fit=fit), late * step


def _products(record: Record) -> FloatArray:
    """Products of the output's samples before one, the input's, a one and the sample.

    Shape (k, k), with k = ORDER + LONGEST + ORDER + 2.
    """
    first, n = LONGEST + ORDER, len(record)
    total = np.zeros((2 * ORDER + LONGEST + 2,) * 2)
    for begin in range(first, n, ROWS):
        end = min(begin + ROWS, n)
        own = np.column_stack(
            [
                *(record.y[begin - k : end - k] for k in range(1, ORDER + 1)),
                *(record.u[begin - k : end - k] for k in range(LONGEST + ORDER)),
                np.ones(end - begin),
                record.y[begin:end],
            ]
        )
        total += own.T @ own
    return total


def _error(gram: FloatArray, late: int) -> float:
    """Sum of squares that a model with so late an input leaves."""
    used = [*range(ORDER), *range(ORDER + late, 2 * ORDER + late), -2]
    inner = gram[np.ix_(used, used)]
    size = np.sqrt(np.maximum(np.diag(inner), 1e-300))
    right = gram[used, -1] / size
    found = np.linalg.lstsq(inner / np.outer(size, size), right, rcond=1e-12)[0]
    return float(gram[-1, -1] - found @ right)
