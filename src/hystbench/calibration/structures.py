"""Structures and readings beside the chosen one, judged by one rule.

Each is refitted a little from the chosen twin, and each calibration signal is left out
in turn. No held-out row is read here.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.calibration.crossvalidation import LeftOut, leave_one_out
from hystbench.calibration.fit import Tell, descend, tune_steps
from hystbench.calibration.found import values_of
from hystbench.calibration.objective import Objective, error_residual
from hystbench.calibration.targets import targets
from hystbench.calibration.twin import STEP_NAMES, UNKNOWNS, Unknown, make_twin
from hystbench.errors import InputError, nearest
from hystbench.files import write_csv
from hystbench.model import Model
from hystbench.published import FILTERS
from hystbench.signals import make_signal

EVALUATIONS = 4
"""Of a descent: few, since each starts from the chosen twin."""
LEFT_OUT_EVALUATIONS = 3

Chain = list[dict[str, Any]]
Edit = Callable[[Chain, dict[str, float]], Chain]


def _as_it_is(chain: Chain, values: dict[str, float]) -> Chain:
    return chain


@dataclass(frozen=True)
class Structure:
    """What sets a twin or a reading apart from the chosen one.

    Parameters
    ----------
    name, meaning : str
    edit : callable
        The chain made of the chosen twin's chain and the values.
    more : tuple of Unknown
        What is free beside.
    fixed : dict of str to float
        Unknowns of the chosen structure that are not free, and what they are.
    start : dict of str to float
        Where the search starts elsewhere than the chosen twin.
    duration_s : float
        Length of the records.
    backlash : str
        Where the plays of the backlash filter are.
    window_start_s : float
        Errors before it are left out.
    """

    name: str
    meaning: str
    edit: Edit = _as_it_is
    more: tuple[Unknown, ...] = ()
    fixed: dict[str, float] = field(default_factory=dict)
    start: dict[str, float] = field(default_factory=dict)
    duration_s: float = 2.0
    backlash: str = "delay-line"
    window_start_s: float = 0.0

    @property
    def unknowns(self) -> tuple[Unknown, ...]:
        """What is free."""
        return (*(x for x in UNKNOWNS if x.name not in self.fixed), *self.more)

    def make(self, values: dict[str, float]) -> Model:
        """Make the twin that values of the unknowns make."""
        full = {**values, **self.fixed}
        base = make_twin(full)
        content = base.to_mapping()
        if self.edit is not _as_it_is:
            content = {**content, "chain": self.edit(content["chain"], full)}
            content.pop("provenance", None)
        return Model.from_mapping(content, self.name)


def _diffusion(chain: Chain, values: dict[str, float]) -> Chain:
    block = {"eddy-diffusion": {"time_constant_s": values["diffusion"]}}
    return [block if "transfer-function" in item else item for item in chain]


def _creep(chain: Chain, values: dict[str, float]) -> Chain:
    own = {
        "magnitudes": [values["creep"]],
        "time_constants_s": [values["creep time"]],
    }
    return [*chain[:-2], {"creep": own}, *chain[-2:]]


def _bias(chain: Chain, values: dict[str, float]) -> Chain:
    return [{"gain": {"value": 1.0, "offset": values["bias"]}}, *chain]


STRUCTURES = (
    Structure("chosen", "as committed"),
    Structure("zero-positive", "zero error from above", start={"input zero": 0.0057}),
    Structure("zero-none", "filters read the true input", fixed={"input zero": 0.0}),
    Structure(
        "eddy-diffusion",
        "diffusion into a slab instead of the lag",
        _diffusion,
        (Unknown("diffusion", "s", 0.0024, 1e-4, 0.05, True, "diffusion time"),),
        {"zero": 1000.0, "pole": 1000.0},
    ),
    Structure(
        "creep",
        "one creep term more",
        _creep,
        (
            Unknown("creep", "-", 0.005, 0.0, 0.3, False, "share of the creep"),
            Unknown("creep time", "s", 0.2, 0.02, 10, True, "its time constant"),
        ),
    ),
    Structure(
        "bias",
        "constant current before the hysteresis",
        _bias,
        (Unknown("bias", "A", 0.0, -0.1, 0.1, False, "DC state"),),
    ),
    Structure("symmetric", "without the square", fixed={"asymmetry": 0.0}),
    Structure("record-1s", "records of 1 s", duration_s=1.0),
    Structure("record-4s", "records of 4 s", duration_s=4.0),
    Structure("current-input", "plays on the newest input", backlash="current-input"),
    Structure("window", "without the first 0.1 s", window_start_s=0.1),
)


def find_structure(name: str) -> Structure:
    """Give a structure by its name.

    Raises
    ------
    InputError
        If there is none.
    """
    known = {item.name: item for item in STRUCTURES}
    if name not in known:
        raise InputError(f"no structure {name!r}; {nearest(name, known)}")
    return known[name]


def make_objective(structure: Structure, job: Mapping[str, Any]) -> Objective:
    """Make the objective of a structure from the settings of the calibration."""
    signals = {}
    for name, own in job["signals"].items():
        common = {**own["common"], "duration_s": structure.duration_s}
        signals[name] = make_signal(name, own["definition"], common)
    backlash = {**job["filters"]["backlash"], "backlash_structure": structure.backlash}
    return Objective(
        signals,
        {**job["filters"], "backlash": backlash},
        job["seed"],
        structure.window_start_s,
        structure.unknowns,
        structure.make,
    )


def try_structure(
    structure: Structure,
    job: Mapping[str, Any],
    twin: Model,
    tell: Tell = lambda line: None,
) -> dict[str, Any]:
    """Refit a structure from the chosen twin and leave each signal out in turn.

    Parameters
    ----------
    structure : Structure
    job : mapping
        Settings of the calibration, with the committed step sizes
        (``convergence_factor``) and ``input_zero_error``.
    twin : Model
        The chosen twin.
    tell : callable
        Told one line of progress at a time.

    Returns
    -------
    dict
        ``cost``, ``values``, ``score`` (half the sum of squared residuals of the
        left-out cells) and ``left_out``.
    """
    aims = targets(job["signals"])
    objective = make_objective(structure, job)
    known = {item.name: item.start for item in structure.more} | values_of(twin)
    known["input zero"] = job["input_zero_error"]
    for model, own in STEP_NAMES.items():
        for key, name in own.items():
            known[name] = job["convergence_factor"][model][key]
    known |= structure.start
    start = {item.name: known[item.name] for item in structure.unknowns}
    near = descend(objective, aims, start, EVALUATIONS)
    tuned = tune_steps(objective, aims, near.values)
    best = descend(objective, aims, tuned, EVALUATIONS)
    tell(f"{structure.name}: cost {best.cost:.4g}")
    left_out = leave_one_out(
        objective, aims, best, evaluations=LEFT_OUT_EVALUATIONS, tell=tell
    )
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
        "meaning": structure.meaning,
        "cost": best.cost,
        "values": best.values,
        "score": score,
        "left_out": [asdict(item) for item in left_out],
    }


COLUMNS = (
    "structure",
    "meaning",
    "in_sample_cost",
    "left_out_score",
    *(f"left_out_median_{model}" for model in FILTERS),
    "left_out_within_factor_2",
    "left_out_worst_factor",
    "left_out_rms_percent",
)


def write_structures(path: Path, tried: Sequence[Mapping[str, Any]]) -> None:
    """Write a row for each structure, least left-out score first."""
    rows = []
    for item in sorted(tried, key=lambda item: float(item["score"])):
        left_out = [LeftOut(**one) for one in item["left_out"]]
        sizes = np.abs([[one.log10_ratio[m] for m in FILTERS] for one in left_out])
        rows.append(
            [
                item["name"],
                item["meaning"],
                f"{item['cost']:.2f}",
                f"{item['score']:.2f}",
                *(f"{value:.3f}" for value in np.median(sizes, axis=0)),
                f"{np.mean(sizes <= np.log10(2)):.3f}",
                f"{10 ** sizes.max():.2f}",
                f"{100 * max(abs(one.rms_error) for one in left_out):.1f}",
            ]
        )
    write_csv(path, COLUMNS, rows)
