"""Twins that are as good as the best one: what the targets leave open."""

from __future__ import annotations

import numpy as np

from hystbench.errors import InputError
from hystbench.twins.calibrate import MET, NAMES, jacobian
from hystbench.twins.constraints import violations
from hystbench.twins.objective import Objective
from hystbench.twins.plant import SHARED, UNKNOWNS, make_twin
from hystbench.twins.search import Fit, Tell, to_point, to_values
from hystbench.twins.targets import Target

TOLERANCE = 0.1
"""A twin is as good as the best if its cost is at most a tenth higher."""


def equally_good(
    objective: Objective,
    targets: tuple[Target, ...],
    best: Fit,
    *,
    count: int = 20,
    seed: int = 1,
    tell: Tell = lambda line: None,
) -> tuple[Fit, ...]:
    """Draw twins whose cost is at most a tenth above the best one's.

    What belongs to the experiment (:data:`hystbench.twins.plant.SHARED`) stays as it
    is. Around the best twin the cost grows by ``|J step|^2 / 2``, J the Jacobian of
    the residuals. Steps are drawn within the ellipsoid where that growth is a tenth of
    the cost; directions that the targets do not feel are held to a quarter of the
    bounds. A drawn twin counts only if its true cost keeps the promise and it meets
    the constraints. Where few do, the ellipsoid shrinks.

    Parameters
    ----------
    objective : Objective
    targets : tuple of Target
    best : Fit
    count, seed : int
        How many twins, and what draws them.
    tell : callable
        Told one line after each twin.

    Raises
    ------
    InputError
        If so many cannot be found.
    """
    centre = to_point(UNKNOWNS, best.values)
    plant = [k for k, name in enumerate(NAMES) if name not in SHARED]
    slopes = jacobian(objective, targets, centre)[:, plant]
    _, sizes, axes = np.linalg.svd(slopes, full_matrices=False)
    radius = np.sqrt(2 * TOLERANCE * best.cost)
    reach = radius / np.maximum(sizes, radius / 0.25)  # a quarter of the bounds at most
    rng = np.random.default_rng(seed)
    found: list[Fit] = []
    shrink = 1.0
    for draw in range(40 * count):
        direction = rng.standard_normal(len(reach))
        direction *= rng.random() ** (1 / len(reach)) / np.linalg.norm(direction)
        point = centre.copy()
        point[plant] += shrink * axes.T @ (reach * direction)
        if ((point > 0) & (point < 1)).all():
            values = to_values(UNKNOWNS, point)
            cost = float(np.sum(objective.residuals(values, targets) ** 2) / 2)
            met = max(violations(make_twin(values)).values()) <= MET
            if met and cost <= (1 + TOLERANCE) * best.cost:
                found.append(Fit(values, cost))
                tell(f"twin {len(found)} of {count}: cost {cost:.4g}")
        if len(found) == count:
            return tuple(found)
        if (draw + 1) % count == 0 and len(found) < (draw + 1) / 8:
            shrink *= 0.8
    raise InputError(
        f"calibration: {len(found)} of {count} equally good twins found; "
        "expected a best twin inside its bounds"
    )
