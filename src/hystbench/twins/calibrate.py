"""Finding the twin that is nearest to the targets."""

from __future__ import annotations

import numpy as np

from hystbench.errors import InputError
from hystbench.record import FloatArray
from hystbench.twins.objective import Objective
from hystbench.twins.plant import STEP_NAMES, UNKNOWNS
from hystbench.twins.search import Fit, Tell, Values, descend, to_point, to_values
from hystbench.twins.targets import Target

NAMES = [item.name for item in UNKNOWNS]
OWNER = {name: model for model, own in STEP_NAMES.items() for name in own.values()}
"""The filter of each step size."""
DIFFERENCE = 2e-3
"""Of the bounds, for slopes: finer ones see the steps of the play operators."""
MET = 1e-3
"""A constraint that is exceeded by no more is met."""


def calibrate(
    objective: Objective,
    targets: tuple[Target, ...],
    *,
    starts: int,
    seed: int,
    tell: Tell = lambda line: None,
) -> Fit:
    """Find the nearest twin from several starts.

    The first start is the stated one, the others are drawn around it. Each descends a
    little; the best goes on to the end.

    Parameters
    ----------
    objective : Objective
    targets : tuple of Target
    starts, seed : int
        How many starts, and what draws them.
    tell : callable
        Told one line after each descent.

    Raises
    ------
    InputError
        If the best twin violates a constraint: which one and by how much.
    """
    rng = np.random.default_rng(seed)
    centre = to_point(UNKNOWNS, {item.name: item.start for item in UNKNOWNS})
    found = []
    for number in range(starts):
        spread = 0.1 * rng.standard_normal(len(centre)) * (number > 0)
        start = to_values(UNKNOWNS, np.clip(centre + spread, 0.02, 0.98))
        near = nearest_twin(objective, targets, start, 8)
        tuned = tune_steps(objective, targets, near.values)
        found.append(nearest_twin(objective, targets, tuned, 10))
        tell(f"start {number + 1} of {starts}: cost {found[number].cost:.4g}")
    best = min(found, key=lambda fit: fit.cost)
    final = nearest_twin(objective, targets, best.values, 40)
    tell(f"finished: cost {final.cost:.4g}")
    for name, excess in objective.excesses(final.values, targets).items():
        if excess > MET:
            raise InputError(
                f"calibration: constraint {name!r} is exceeded by {excess:.3g}; "
                "expected a twin that meets it (more starts, other bounds)"
            )
    return final


def nearest_twin(
    objective: Objective,
    targets: tuple[Target, ...],
    start: Values,
    evaluations: int,
) -> Fit:
    """Descend from a start."""
    return descend(
        lambda values: objective.residuals(values, targets),
        UNKNOWNS,
        to_point(UNKNOWNS, start),
        evaluations,
        jac=lambda here: jacobian(objective, targets, here),
    )


def tune_steps(
    objective: Objective, targets: tuple[Target, ...], values: dict[str, float]
) -> dict[str, float]:
    """Find better step sizes for a twin as it is, each filter by itself.

    The errors have several valleys along a step size, and a descent stays in the one
    where it starts: so factors of up to 8 are tried, for as long as one is better.
    """
    objective.residuals(values, targets)  # measures the records
    best = dict(values)
    limits = {item.name: (item.low, item.high) for item in UNKNOWNS}
    for model, own in STEP_NAMES.items():
        cost = np.sum(objective.step_residuals(best, targets, model) ** 2)
        better = True
        while better:
            better = False
            for name in own.values():
                for factor in (1 / 8, 1 / 3, 1 / 1.5, 1.5, 3, 8):
                    moved = float(np.clip(best[name] * factor, *limits[name]))
                    trial = best | {name: moved}
                    after = np.sum(objective.step_residuals(trial, targets, model) ** 2)
                    if after < cost * (1 - 1e-3):
                        best, cost, better = trial, after, True
    return best


def jacobian(
    objective: Objective, targets: tuple[Target, ...], point: FloatArray
) -> FloatArray:
    """Differentiate the residuals at a point, by differences.

    Returns
    -------
    ndarray, shape (residuals, unknowns)
    """

    def values(moved: FloatArray) -> Values:
        return to_values(UNKNOWNS, moved)

    now = objective.residuals(values(point), targets)
    columns = np.zeros((len(now), len(point)))
    models = list(STEP_NAMES)
    # Steps first: they use the records that the call above has left.
    for k in sorted(range(len(point)), key=lambda k: NAMES[k] not in OWNER):
        h = DIFFERENCE if point[k] + DIFFERENCE <= 1 else -DIFFERENCE
        moved = point.copy()
        moved[k] += h
        model = OWNER.get(NAMES[k])
        if model is None:
            after = objective.residuals(values(moved), targets)
            columns[:, k] = (after - now) / h
            continue
        place = models.index(model)
        errors = np.arange(len(targets)) * len(models) + place
        # After the errors come an RMS a target, then a margin a model.
        rows = [*errors, len(targets) * (len(models) + 1) + place]
        after = objective.step_residuals(values(moved), targets, model)
        columns[rows, k] = (after - now[rows]) / h
    return columns
