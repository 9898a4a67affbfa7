"""The trial of structures: the same budget for each, and nothing that remembers.

No held-out row is read here, and no start comes from a fit.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from functools import partial
from typing import Any

import numpy as np

from hystbench.calibration.constraints import violations
from hystbench.calibration.crossvalidation import leave_one_out
from hystbench.calibration.fit import Fit, Tell, descend, to_values, tune_steps
from hystbench.calibration.objective import Objective, error_residual
from hystbench.calibration.structures import Structure, make_objective
from hystbench.calibration.targets import Target, targets
from hystbench.calibration.twin import BASE_UNKNOWNS

SPREAD = 0.05
"""Standard deviation of the starts around the middle, as a share of the bounds."""


def starts(structure: Structure, count: int, seed: int) -> list[dict[str, float]]:
    """Give the points from which a structure is fitted.

    The first is the middle of the bounds, the others are drawn around it. None knows
    of a fit. The draws of an unknown are the same in all structures.
    """
    rng = np.random.default_rng(seed)
    unknowns = structure.unknowns
    base = [item.name for item in BASE_UNKNOWNS]
    more = [item.name for item in unknowns if item.name not in base]
    # Those of the base first, whether free or not, so that each keeps its draws.
    draws = [rng.standard_normal((count, len(names))) for names in (base, more)]
    found = []
    for number, drawn in enumerate(np.hstack(draws)):
        draw = dict(zip([*base, *more], drawn, strict=True))
        away = [SPREAD * draw[item.name] * (number > 0) for item in unknowns]
        point = to_values(np.clip(0.5 + np.array(away), 0.02, 0.98), unknowns)
        found.append(point | structure.starts[number % len(structure.starts)])
    return found


def search(
    objective: Objective,
    points: Sequence[dict[str, float]],
    budget: Mapping[str, int],
    aims: tuple[Target, ...],
) -> Fit:
    """Descend from each point, and once more from the best of what they reach.

    Parameters
    ----------
    objective : Objective
    points : sequence of dict of str to float
        Where to start.
    budget : mapping
        ``evaluations`` of each descent and ``last_evaluations`` of the last one.
    aims : tuple of Target
        What is fitted to.
    """
    near = [_descent(objective, aims, point, budget["evaluations"]) for point in points]
    best = min(near, key=lambda fit: fit.cost)
    last = _descent(objective, aims, best.values, budget["last_evaluations"])
    return min(best, last, key=lambda fit: fit.cost)


def try_structure(
    structure: Structure, job: Mapping[str, Any], tell: Tell = lambda line: None
) -> dict[str, Any]:
    """Fit a structure to all calibration signals, and without each of them in turn.

    Each of these fits has the same starts and the same budget.

    Parameters
    ----------
    structure : Structure
    job : mapping
        Settings of the trial, as :func:`make_objective` takes them, and ``budget``:
        ``starts``, ``evaluations``, ``last_evaluations`` and ``seed``.
    tell : callable
        Told one line of progress at a time.

    Returns
    -------
    dict
        ``cost``, ``values``, ``constraints_met``, ``score`` (half the sum of squared
        residuals of the left-out cells) and ``left_out``.
    """
    aims, budget = targets(job["signals"]), job["budget"]
    objective = make_objective(structure, job)
    points = starts(structure, budget["starts"], budget["seed"])
    find = partial(search, objective, points, budget)
    best = find(aims)
    tell(f"{structure.name}: cost {best.cost:.4g}")
    left_out = leave_one_out(objective, aims, find, tell=tell)
    by_name = {aim.signal: aim for aim in aims}
    score = sum(
        error_residual(
            model, by_name[one.signal].mse[model] * 10**ratio, by_name[one.signal]
        )
        ** 2
        / 2
        for one in left_out
        for model, ratio in one.log10_ratio.items()
    )
    return {
        "name": structure.name,
        "cost": best.cost,
        "values": best.values,
        "constraints_met": max(violations(structure.make(best.values)).values())
        <= 1e-3,
        "score": score,
        "left_out": [asdict(item) for item in left_out],
    }


def _descent(
    objective: Objective,
    aims: tuple[Target, ...],
    start: dict[str, float],
    evaluations: int,
) -> Fit:
    """Go down from a point whose step sizes are tuned first.

    Identified envelopes are those of the point where the descent begins; its cost is
    that with the envelopes of where it ends.
    """
    here = objective.at(start)
    fit = descend(here, aims, tune_steps(here, aims, start), evaluations)
    there = objective.at(fit.values)
    if there is objective:
        return fit
    residuals = there.residuals(fit.values, aims)
    return Fit(fit.values, float(residuals @ residuals / 2))
