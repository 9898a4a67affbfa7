"""Finding the twin that is nearest to the targets."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from hystbench.calibration.constraints import violations
from hystbench.calibration.objective import Objective
from hystbench.calibration.targets import Target
from hystbench.calibration.twin import STEP_NAMES, UNKNOWNS, Unknown, make_twin
from hystbench.errors import InputError
from hystbench.files import read_json, write_json
from hystbench.filters import MOST_CORRECTION
from hystbench.record import FloatArray

Tell = Callable[[str], None]


@dataclass(frozen=True)
class Fit:
    """A twin and its distance.

    Parameters
    ----------
    values : dict of str to float
        Values of the unknowns by name.
    cost : float
        Half the sum of squares of the residuals.
    """

    values: dict[str, float]
    cost: float


def to_point(
    values: dict[str, float], unknowns: tuple[Unknown, ...] = UNKNOWNS
) -> FloatArray:
    """Place values in the unit cube of the bounds; logarithms where they are meant."""
    return np.array([_place(item, values[item.name]) for item in unknowns])


def to_values(
    point: FloatArray, unknowns: tuple[Unknown, ...] = UNKNOWNS
) -> dict[str, float]:
    """Give the values of a point in the unit cube."""
    return {
        item.name: _value(item, float(p))
        for item, p in zip(unknowns, point, strict=True)
    }


def descend(
    objective: Objective,
    targets: tuple[Target, ...],
    start: dict[str, float],
    evaluations: int,
) -> Fit:
    """Go down from a start by bounded least squares (trust region reflective)."""
    from scipy.optimize import least_squares  # late: takes a second

    def residuals(point: FloatArray) -> FloatArray:
        return objective.residuals(to_values(point, objective.unknowns), targets)

    def slope(point: FloatArray) -> FloatArray:
        return jacobian(objective, targets, point)

    inside = np.clip(to_point(start, objective.unknowns), 1e-6, 1 - 1e-6)
    result = least_squares(
        residuals, inside, jac=slope, bounds=(0.0, 1.0), max_nfev=evaluations
    )
    return Fit(to_values(result.x, objective.unknowns), float(result.cost))


def tune_steps(
    objective: Objective, targets: tuple[Target, ...], values: dict[str, float]
) -> dict[str, float]:
    """Find better step sizes for a twin as it is, each filter by itself.

    The errors have several valleys along a step size, and a descent stays in the one
    where it starts: so factors of up to 8 are tried, for as long as one is better.
    """
    objective.residuals(values, targets)  # measures the records
    best = dict(values)
    limits = {item.name: (item.low, item.high) for item in objective.unknowns}
    for model, own in STEP_NAMES.items():
        cost = np.sum(objective.step_residuals(best, targets, model) ** 2)
        better = True
        while better:
            better = False
            for name in own.values():
                for factor in (1 / 8, 1 / 3, 1 / 1.5, 1.5, 3, 8):
                    trial = best | {
                        name: float(np.clip(best[name] * factor, *limits[name]))
                    }
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
        A change of 0.002 of the bounds: finer ones see the steps of the play operators.
    """
    now = objective.residuals(to_values(point, objective.unknowns), targets)
    columns = np.zeros((len(now), len(point)))
    owner = {name: model for model, own in STEP_NAMES.items() for name in own.values()}
    models = list(STEP_NAMES)
    # Steps first: they use the records that the call above has left.
    order = sorted(
        range(len(point)), key=lambda k: objective.unknowns[k].name not in owner
    )
    for k in order:
        name = objective.unknowns[k].name
        h = 2e-3 if point[k] + 2e-3 <= 1 else -2e-3
        moved = point.copy()
        moved[k] += h
        values = to_values(moved, objective.unknowns)
        if name in owner:
            place = models.index(owner[name])
            errors = np.arange(len(targets)) * len(models) + place
            # After the errors come an RMS a target, then a margin a model.
            rows = [*errors, len(targets) * (len(models) + 1) + place]
            after = objective.step_residuals(values, targets, owner[name])
            columns[rows, k] = (after - now[rows]) / h
        else:
            columns[:, k] = (objective.residuals(values, targets) - now) / h
    return columns


def calibrate(
    objective: Objective,
    targets: tuple[Target, ...],
    *,
    starts: int,
    seed: int,
    state: Path | None = None,
    tell: Tell = lambda line: None,
) -> Fit:
    """Find the nearest twin from several starts.

    The first start is the stated one, the others are drawn around it. Each descends a
    little; the best goes on to the end. With a state file an interrupted run goes on
    where it stopped; a state of other targets or settings is put aside.

    Parameters
    ----------
    objective : Objective
    targets : tuple of Target
    starts, seed : int
        How many starts, and what draws them.
    state : Path, optional
        File for what is done so far.
    tell : callable
        Told one line after each descent.

    Raises
    ------
    InputError
        If the best twin violates a constraint: which one and by how much.
    """
    key = _key(objective, targets, starts, seed)
    done = _read_state(state, key)
    rng = np.random.default_rng(seed)
    centre = to_point({item.name: item.start for item in UNKNOWNS})
    for number in range(starts):
        spread = 0.1 * rng.standard_normal(len(centre)) * (number > 0)
        if number >= len(done):
            start = to_values(np.clip(centre + spread, 0.02, 0.98))
            near = descend(objective, targets, start, evaluations=8)
            tuned = tune_steps(objective, targets, near.values)
            done.append(descend(objective, targets, tuned, evaluations=10))
            _write_state(state, key, done)
        tell(f"start {number + 1} of {starts}: cost {done[number].cost:.4g}")
    best = min(done[:starts], key=lambda fit: fit.cost)
    if len(done) == starts:
        done.append(descend(objective, targets, best.values, evaluations=40))
        _write_state(state, key, done)
    final = done[-1]
    tell(f"finished: cost {final.cost:.4g}")
    excesses = violations(make_twin(final.values)) | margin_excesses(
        objective, targets, final.values
    )
    for name, excess in excesses.items():
        if excess > 1e-3:
            raise InputError(
                f"calibration: constraint {name!r} is exceeded by {excess:.3g}; "
                "expected a twin that meets it (more starts, other bounds)"
            )
    return final


def margin_excesses(
    objective: Objective, targets: tuple[Target, ...], values: dict[str, float]
) -> dict[str, float]:
    """Tell how far each filter's margin is exceeded; zero or less where it is kept."""
    names = [target.signal for target in targets]
    objective.cells(values, names)  # measures the records
    return {
        f"stability margin of {model}": max(
            objective.corrections(values, model, names).values(), default=0.0
        )
        - MOST_CORRECTION
        for model in STEP_NAMES
    }


def _place(item: Unknown, value: float) -> float:
    if item.logarithmic:
        return float(np.log(value / item.low) / np.log(item.high / item.low))
    return (value - item.low) / (item.high - item.low)


def _value(item: Unknown, place: float) -> float:
    if item.logarithmic:
        return float(item.low * (item.high / item.low) ** place)
    return item.low + place * (item.high - item.low)


def _key(
    objective: Objective, targets: tuple[Target, ...], starts: int, seed: int
) -> str:
    sources = sorted(Path(__file__).parent.glob("*.py"))
    about = {
        # An edited module is another calibration: what was done counts no more.
        "sources": [hashlib.sha256(file.read_bytes()).hexdigest() for file in sources],
        "unknowns": [asdict(item) for item in UNKNOWNS],
        "targets": [asdict(item) for item in targets],
        "filters": {name: dict(job) for name, job in objective.filters.items()},
        "signals": {
            name: hashlib.sha256(signal.u.tobytes()).hexdigest()
            for name, signal in objective.signals.items()
        },
        "noise": objective.seed,
        "window": objective.window_start_s,
        "starts": starts,
        "seed": seed,
    }
    return hashlib.sha256(json.dumps(about, sort_keys=True).encode()).hexdigest()


def _read_state(state: Path | None, key: str) -> list[Fit]:
    if state is None or not state.exists():
        return []
    content = read_json(state)
    if content["key"] != key:
        return []
    return [Fit(**item) for item in content["done"]]


def _write_state(state: Path | None, key: str, done: list[Fit]) -> None:
    if state is not None:
        write_json(state, {"key": key, "done": [asdict(item) for item in done]})
