"""Fitting a family: bounded least squares in two stages."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from hystbench.families.kinds import Family, Unknown
from hystbench.families.task import ASYMMETRY, OFFSET, THINNING, Task
from hystbench.model import Model, Provenance
from hystbench.record import FloatArray

SCALE = 0.01
"""Relative error of the loop, or of one RMS, that counts as one."""
STEP = 1e-4
"""Difference for slopes, relative: finer ones see the steps of the integration."""

Tell = Callable[[str], None]


@dataclass(frozen=True)
class FamilyFit:
    """A twin of another family.

    Parameters
    ----------
    twin : Model
    at_bounds : tuple of str
        Unknowns that ended at one of their bounds.
    """

    twin: Model
    at_bounds: tuple[str, ...] = ()


def fit_family(
    family: Family,
    task: Task,
    starts: int = 12,
    evaluations: int = 50,
    tell: Tell = lambda line: None,
) -> FamilyFit:
    """Fit a family: its block to the loop of ``gpi`` first, then the chain to all.

    The first stage needs no dynamics, since hysteresis does not depend on the rate;
    the best of its random starts goes on. Both are bounded least squares (trust region
    reflective).

    Parameters
    ----------
    family : Family
        One of :data:`FAMILIES`.
    task : Task
    starts, evaluations : int
        Of the first stage, and at most in the second one, slopes not counted.
    tell : callable
        Told one line after each stage.
    """
    from scipy.optimize import least_squares  # late: takes a second

    unknowns = task.unknowns(family)
    own = unknowns[: len(family.unknowns)]
    slow, dt, wanted = task.loop.u[::THINNING], THINNING * task.loop.dt, task.gpi_loop

    def alone(places: FloatArray) -> FloatArray:
        block = family.block(_values(own, places), task.largest)
        error = block.simulate(slow, slow, dt) - wanted
        return np.asarray((error - error.mean()) / np.linalg.norm(wanted) / SCALE)

    rng = np.random.default_rng(task.seed)
    found = [
        least_squares(alone, start, bounds=(0, 1), diff_step=STEP, max_nfev=100)
        for start in rng.uniform(0.2, 0.8, (starts, len(own)))
    ]
    best = min(found, key=lambda result: result.cost)
    error = np.sqrt(2 * best.cost) * SCALE
    tell(f"{family.name}: loop alone: relative error {error:.4f}")

    loop = task.loop_of(task.model)

    def whole(places: FloatArray) -> FloatArray:
        twin = task.twin(family, _values(unknowns, places))
        error = (task.loop_of(twin) - loop) / np.linalg.norm(loop)
        return np.concatenate([error, task.rms_errors(twin)]) / SCALE

    block = family.block(_values(own, best.x), task.largest)
    shift = wanted - block.simulate(slow, slow, dt)
    rest = {item.name: _number(task.model, item.name) for item in unknowns[len(own) :]}
    rest[OFFSET] += float(shift.mean())
    beside = [item.place(rest[item.name]) for item in unknowns[len(own) :]]
    inside = np.clip([*best.x, *beside], 1e-3, 1 - 1e-3)
    final = least_squares(
        whole,
        inside,
        bounds=(0, 1),
        diff_step=STEP,
        max_nfev=evaluations,
        x_scale="jac",
    )
    tell(f"{family.name}: loop and RMS: half the sum of squares {final.cost:.4g}")
    values = {
        key: float(f"{value:.6g}") for key, value in _values(unknowns, final.x).items()
    }
    twin = task.twin(family, values)
    at_bounds = [
        item.name
        for item, place in zip(unknowns, final.x, strict=True)
        if min(place, 1 - place) < 1e-3
    ]
    return FamilyFit(_with_provenance(twin, family, task), tuple(at_bounds))


def _number(model: Model, name: str) -> float:
    value = model.value(name)
    if not isinstance(value, float):
        raise TypeError(f"{name} is no number")
    return value


def _values(unknowns: tuple[Unknown, ...], places: FloatArray) -> dict[str, float]:
    pairs = zip(unknowns, places, strict=True)
    return {item.name: item.value(float(place)) for item, place in pairs}


def _with_provenance(twin: Model, family: Family, task: Task) -> Model:
    fitted = Provenance(
        "calibrated",
        f"Fitted to the slow loop of {task.model.name} and to the implied RMS of "
        f"{len(task.signals)} signals.",
    )
    kept = {
        key: item
        for key, item in task.model.provenance.items()
        if not key.startswith("gpi.")
    }
    block = twin.chain[0]
    own = {
        f"{block.name}.{key}": Provenance("derived", family.derived[key])
        if key in family.derived
        else fitted
        for key in block.to_mapping()
    }
    again = {key: fitted for key in (OFFSET, ASYMMETRY) if key in kept}
    return replace(twin, provenance={**own, **kept, **again})
