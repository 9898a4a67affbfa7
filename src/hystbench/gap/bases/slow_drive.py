"""Records of a drive that may go no faster than a rate, with its output as the input.

Such a drive makes a triangle of a fast sine. Its share of what goes in falls with the
size, and no linear model has that: the poles of the best one make up for it, and the
drive no longer shows beside them. So a linear model is also looked for behind it. It
may go down at another rate than up.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from hystbench.blocks.slew_limit import SlewLimit
from hystbench.gap.bases.spectral import Spectra, fit_ratio
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.thresholds import LOOSE, NUMBER_PAYS
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
FURTHER_STEPS = 80
"""Drives that are tried with another rate downwards, or with a lag as well."""
LONGEST_LAG = SlewLimit.parameters()["time_constant_s"].high
"""In seconds: the longest that the block may have."""


def behind_a_slow_drive(evidence: Evidence) -> tuple[Evidence, SlewLimit] | None:
    """Give the fit records with what such a drive makes of their inputs.

    Where that takes what matters of the power, a servo of two rates that lags below
    them is tried as well; each number that it has more must lower the error by what a
    number has to. Steps within a sample, and a noisy input, hide a rate: those tried
    are shares of the fastest move from one sample to the next.

    Returns
    -------
    tuple or None
        The records, and the drive; None where no rate lets a linear model leave less
        than a quarter of the power that one leaves without a limit.
    """
    records = evidence.fit
    if any(record.decay_s is not None for record in records):
        return None  # what a free mass forgets of its start depends on its input
    fastest = max(record.fastest for record in records)
    if fastest == 0:
        return None
    parts = [_about_the_fastest(record) for record in records]

    def left(drive: SlewLimit) -> float:
        slowed = _slowed(records, drive)
        few = [record.cut(part) for record, part in zip(slowed, parts, strict=True)]
        return fit_ratio(Spectra.of(few, evidence.input_hold), ORDER, ORDER).cost

    rates = fastest * np.geomspace(SLOWEST, 1.0, RATES)
    costs = [left(SlewLimit(rate=rate)) for rate in rates.tolist()]
    best = int(np.argmin(costs))
    if costs[best] >= costs[-1]:
        return None
    from scipy.optimize import minimize_scalar  # late: few drives are slow

    found = minimize_scalar(
        lambda rate: left(SlewLimit(rate=rate)),
        bounds=(rates[max(best - 1, 0)], rates[best + 1]),
        method="bounded",
        options={"maxiter": STEPS},
    )
    rate = float(found.x if found.fun < costs[best] else rates[best])
    drive, cost = SlewLimit(rate=rate), min(found.fun, costs[best])
    if cost < (1 - LOOSE) * costs[-1]:
        drive, cost = _with_more_numbers(drive, cost, left, records[0].dt)
    if cost > LOOSE * costs[-1]:
        return None
    return replace(evidence, fit=_slowed(records, drive)), drive


def _with_more_numbers(
    drive: SlewLimit, cost: float, left: Callable[[SlewLimit], float], dt: float
) -> tuple[SlewLimit, float]:
    """Let a drive fall at another rate, and lag as a servo, where each number pays."""
    from scipy.optimize import minimize

    def drive_of(logs: Sequence[float]) -> SlewLimit:
        rate, falling, *lag = np.exp(logs).tolist()
        tau = min(lag[0], LONGEST_LAG) if lag else 0.0
        return SlewLimit(rate=rate, falling=falling, time_constant_s=tau, form="sharp")

    def best_from(*start: float) -> tuple[SlewLimit, float]:
        middle = np.log(start)
        simplex = np.vstack([middle, middle + np.log(1.5) * np.eye(len(start))])
        found = minimize(
            lambda logs: left(drive_of(logs)),
            middle,
            method="Nelder-Mead",
            options={"maxfev": FURTHER_STEPS, "initial_simplex": simplex},
        )
        return drive_of(found.x), float(found.fun)

    # One number more, then two; a cost is a power, and so goes with the square.
    rate = drive.rate
    one_more, two_more = ((1 - NUMBER_PAYS) ** (2 * k) * cost for k in (1, 2))
    of_two_rates, its_cost = best_from(rate, rate)
    if its_cost < one_more:
        drive, cost = of_two_rates, its_cost
    with_a_lag, its_cost = best_from(rate, rate, 3 * dt)
    if its_cost < min(cost, two_more):
        drive, cost = with_a_lag, its_cost
    return drive, cost


def _about_the_fastest(record: Record) -> slice:
    at = int(np.argmax(np.abs(np.diff(record.u))))
    first = max(min(at - ENOUGH // 2, len(record) - ENOUGH), 0)
    return slice(first, first + ENOUGH)


def _slowed(records: Sequence[Record], drive: SlewLimit) -> tuple[Record, ...]:
    return tuple(replace(x, u=drive.simulate(x.u, x.u, x.dt)) for x in records)
