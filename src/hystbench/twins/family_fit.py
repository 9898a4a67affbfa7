"""Fitting a family: its block to the slow loop first, then the chain to all."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hystbench.model import Model
from hystbench.model_content import Provenance
from hystbench.record import FloatArray
from hystbench.twins.families import ASYMMETRY, OFFSET, THINNING, Family, FamilyTask
from hystbench.twins.search import Tell, Values, descend, to_point

SCALE = 0.01
"""Relative error of the loop, or of one RMS, that counts as one."""
STEP = 1e-4
"""Difference for slopes, relative: finer ones see the steps of the integration."""
AT_BOUND = 1e-3
"""A value within this share of the bounds of one of them is at it."""


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
    task: FamilyTask,
    starts: int = 12,
    evaluations: int = 50,
    tell: Tell = lambda line: None,
) -> FamilyFit:
    """Fit a family: its block to the loop of ``gpi`` first, then the chain to all.

    The first stage needs no dynamics, since hysteresis does not depend on the rate;
    the best of its random starts goes on.

    Parameters
    ----------
    family : Family
        One of :data:`hystbench.twins.families.FAMILIES`.
    task : FamilyTask
    starts, evaluations : int
        Of the first stage, and at most in the second one, slopes not counted.
    tell : callable
        Told one line after each stage.
    """
    unknowns = task.unknowns(family)
    own, rest = unknowns[: len(family.unknowns)], unknowns[len(family.unknowns) :]
    slow, dt, wanted = task.loop.u[::THINNING], THINNING * task.loop.dt, task.gpi_loop

    def missing(values: Values) -> FloatArray:
        block = family.block(values, task.largest)
        return np.asarray(block.simulate(slow, slow, dt) - wanted)

    def alone(values: Values) -> FloatArray:
        error = missing(values)
        return np.asarray((error - error.mean()) / np.linalg.norm(wanted) / SCALE)

    rng = np.random.default_rng(task.seed)
    points = rng.uniform(0.2, 0.8, (starts, len(own)))
    found = [descend(alone, own, point, 100, diff_step=STEP) for point in points]
    best = min(found, key=lambda fit: fit.cost)
    error = np.sqrt(2 * best.cost) * SCALE
    tell(f"{family.name}: loop alone: relative error {error:.4f}")

    loop = task.loop_of(task.model)

    def whole(values: Values) -> FloatArray:
        twin = task.twin(family, values)
        error = (task.loop_of(twin) - loop) / np.linalg.norm(loop)
        return np.concatenate([error, task.rms_errors(twin)]) / SCALE

    beside = {item.name: task.number(item.name) for item in rest}
    beside[OFFSET] -= float(missing(best.values).mean())
    start = np.array([*best.places, *to_point(rest, beside)])
    options: dict[str, Any] = {"diff_step": STEP, "x_scale": "jac"}
    final = descend(whole, unknowns, start, evaluations, edge=AT_BOUND, **options)
    tell(f"{family.name}: loop and RMS: half the sum of squares {final.cost:.4g}")
    at_bounds = [
        item.name
        for item, place in zip(unknowns, final.places, strict=True)
        if min(place, 1 - place) < AT_BOUND
    ]
    legible = {key: float(f"{value:.6g}") for key, value in final.values.items()}
    twin = _with_provenance(task.twin(family, legible), family, task)
    return FamilyFit(twin, tuple(at_bounds))


def judge(task: FamilyTask, twin: Model) -> Mapping[str, Any]:
    """Tell how near a twin comes: error of the loop (relative) and of RMS (percent)."""
    names = [signal.name for signal in task.signals]
    percent = [round(100 * float(each), 4) for each in task.rms_errors(twin)]
    return {
        "loop_relative_error": task.loop_error(twin),
        "rms_error_percent": dict(zip(names, percent, strict=True)),
    }


def _with_provenance(twin: Model, family: Family, task: FamilyTask) -> Model:
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
