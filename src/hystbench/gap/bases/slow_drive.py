"""Records of a drive that may go no faster than a rate, with its output as the input.

Such a drive makes a triangle of a fast sine. Its share of what goes in falls with the
size, and no linear model has that: the poles of the best one make up for it, and the
drive no longer shows beside them. So a linear model is also looked for behind it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hystbench.blocks.slew_limit import SlewLimit
from hystbench.gap.bases.spectral import Spectra, fit_ratio
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.thresholds import LOOSE
from hystbench.record import Record

ORDER = 3
"""Order of the linear models by which rates are compared: a mode and a lag."""
SLOWEST = 0.05
"""Share of the inputs' fastest rate that is the slowest tried."""
RATES = 10
"""How many are tried, before the best is refined."""
ENOUGH = 2000
"""Samples of each record that rates are compared on, about where it moves fastest."""
STEPS = 12
"""Rates tried between the neighbours of the best."""


def behind_a_slow_drive(evidence: Evidence) -> tuple[Evidence, float] | None:
    """Give the fit records with what such a drive makes of their inputs.

    Returns
    -------
    tuple or None
        The records, and the rate in units of the input a second; None where no rate
        lets a linear model leave less than a quarter of the power that one leaves
        without a limit. Steps within a sample, and a noisy input, hide the rate: those
        tried are shares of the fastest move from one sample to the next.
    """
    records = evidence.fit
    if any(record.decay_s is not None for record in records):
        return None  # what a free mass forgets of its start depends on its input
    fastest = max(record.fastest for record in records)
    if fastest == 0:
        return None
    parts = [_about_the_fastest(record) for record in records]

    def left(share: float) -> float:
        slowed = _slowed(records, share * fastest)
        few = [record.cut(part) for record, part in zip(slowed, parts, strict=True)]
        return fit_ratio(Spectra.of(few, evidence.input_hold), ORDER, ORDER).cost

    shares = np.geomspace(SLOWEST, 1.0, RATES)
    costs = [left(share) for share in shares.tolist()]
    best = int(np.argmin(costs))
    if costs[best] >= costs[-1]:
        return None
    from scipy.optimize import minimize_scalar  # late: few drives are slow

    low, high = shares[max(best - 1, 0)], shares[best + 1]
    steps = {"maxiter": STEPS}
    found = minimize_scalar(left, bounds=(low, high), method="bounded", options=steps)
    if min(found.fun, costs[best]) > LOOSE * costs[-1]:
        return None
    share = found.x if found.fun < costs[best] else shares[best]
    rate = float(share) * fastest
    return replace(evidence, fit=_slowed(records, rate)), rate


def _about_the_fastest(record: Record) -> slice:
    at = int(np.argmax(np.abs(np.diff(record.u))))
    first = max(min(at - ENOUGH // 2, len(record) - ENOUGH), 0)
    return slice(first, first + ENOUGH)


def _slowed(records: Sequence[Record], rate: float) -> tuple[Record, ...]:
    drive = SlewLimit(rate=rate)
    return tuple(replace(x, u=drive.simulate(x.u, x.u, x.dt)) for x in records)
