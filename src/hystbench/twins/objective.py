"""How far a twin and its step sizes are from the targets."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from hystbench.adaptive import make_filter
from hystbench.filters import MOST_CORRECTION
from hystbench.measurement import measure
from hystbench.metrics import mean_square_error
from hystbench.model import Model
from hystbench.record import FloatArray, Record
from hystbench.signals import Signal
from hystbench.twins.constraints import violations
from hystbench.twins.plant import STEP_NAMES, make_twin, step_sizes
from hystbench.twins.search import Values
from hystbench.twins.targets import Target

LOG_SCALE = {"gpo": 0.06, "backlash": 0.10, "volterra": 0.08, "delayed": 0.08}
"""A deviation of log10 MSE that counts as one; beyond it a cell counts less."""
RMS_SCALE = 0.01
"""A relative deviation of the RMS displacement that counts as one."""
CONSTRAINT_SCALE = {
    "chirp least (s)": 0.002,
    "chirp greatest (s)": 0.002,
    "rise at the mode": 0.01,
}
"""An excess over a constraint that counts as one: little, since it must be met."""
MARGIN_SCALE = 0.005
"""An excess over :data:`MOST_CORRECTION` that counts as one."""
INCONSISTENT_WEIGHT = 0.5
DIVERGED = 1e4  # um^2, stands for an MSE that is not a number


@dataclass(frozen=True)
class Cells:
    """Errors of the filters on the records of a twin.

    Parameters
    ----------
    mse : dict of str to dict of str to float
        MSE (um^2) by signal and filter.
    rms : dict of str to float
        RMS displacement (um) by signal.
    """

    mse: dict[str, dict[str, float]]
    rms: dict[str, float]


@dataclass(frozen=True)
class Objective:
    """Residuals of a twin on some signals.

    Parameters
    ----------
    signals : mapping of str to Signal
        Excitations by name.
    filters : mapping of str to mapping
        Settings of each filter's job, as :func:`hystbench.adaptive.make_filter` takes
        them, but for the step sizes.
    seed : int
        Seed of the noise, as of ``hystbench job measure``.
    """

    signals: Mapping[str, Signal]
    filters: Mapping[str, Mapping[str, Any]]
    seed: int
    _records: dict[str, Record] = field(default_factory=dict, repr=False)
    _powers: dict[tuple[Any, ...], float] = field(default_factory=dict, repr=False)

    def record(self, name: str, model: Model, values: Values) -> Record:
        """Measure a signal on a twin as ``hystbench job measure`` does.

        Of the values only what the recorded input has beside the actuator's is taken.
        """
        settings = {
            "seed": self.seed,
            "input_zero_error": values.get("input zero", 0.0),
            "input_noise": values.get("input noise", 0.0),
        }
        return measure(self.signals[name], model, settings, "calibration")

    def corrections(
        self, values: Values, model: str, names: Iterable[str]
    ) -> dict[str, float]:
        """Largest correction of a filter on some signals, 2 mu max|H|^2.

        It is the filter's stability margin; see
        :meth:`hystbench.filters.AdaptiveFilter.correction`. The records are those of
        the last :meth:`cells`.
        """
        settings = {
            **self.filters[model],
            "convergence_factor": step_sizes(values)[model],
        }
        found = {}
        for name in names:
            record = self._records[name]
            adaptive = make_filter(model, settings, record)
            # No plant and no step size changes the regressor: only the input does.
            recorded = (values.get("input zero", 0.0), values.get("input noise", 0.0))
            key = (model, name, *recorded)
            if key not in self._powers:
                self._powers[key] = adaptive.largest_power(record.u)
            found[name] = adaptive.correction(self._powers[key])
        return found

    def mse(self, model: str, record: Record, steps: Mapping[str, float]) -> float:
        """MSE of a filter on a record."""
        settings = {**self.filters[model], "convergence_factor": steps}
        result = make_filter(model, settings, record).run(record.u, record.y)
        if result.diverged_at is not None:
            return DIVERGED
        return mean_square_error(result.error)

    def cells(self, values: Values, names: Iterable[str]) -> Cells:
        """Errors of every filter on some signals."""
        twin, steps = make_twin(values), step_sizes(values)
        mse, rms = {}, {}
        for name in names:
            record = self._records[name] = self.record(name, twin, values)
            rms[name] = float(np.sqrt(np.mean(record.y**2)))
            mse[name] = {
                model: self.mse(model, record, steps[model]) for model in steps
            }
        return Cells(mse, rms)

    def residuals(self, values: Values, targets: tuple[Target, ...]) -> FloatArray:
        """Give the residuals: errors, RMS, stability margins, constraints.

        Errors come by signal and filter, RMS by signal and margins by filter.
        """
        names = [target.signal for target in targets]
        found = self.cells(values, names)
        out = [
            error_residual(model, found.mse[target.signal][model], target)
            for target in targets
            for model in STEP_NAMES
        ]
        out += [
            (found.rms[target.signal] / target.rms - 1) / RMS_SCALE
            for target in targets
        ]
        out += [self._margin_residual(values, model, names) for model in STEP_NAMES]
        out += [
            max(excess, 0.0) / CONSTRAINT_SCALE[name]
            for name, excess in violations(make_twin(values)).items()
        ]
        return np.array(out)

    def step_residuals(
        self, values: Values, targets: tuple[Target, ...], model: str
    ) -> FloatArray:
        """Give one filter's residuals on the records of the last :meth:`cells`.

        Its errors by signal, then its stability margin. A step size changes nothing
        else, so its column of the Jacobian is cheap.
        """
        steps = step_sizes(values)[model]
        errors = [
            error_residual(
                model, self.mse(model, self._records[target.signal], steps), target
            )
            for target in targets
        ]
        names = [target.signal for target in targets]
        return np.array([*errors, self._margin_residual(values, model, names)])

    def excesses(self, values: Values, targets: tuple[Target, ...]) -> dict[str, float]:
        """Tell how far each constraint is exceeded; zero or less where it is met."""
        names = [target.signal for target in targets]
        self.cells(values, names)  # measures the records
        margins = {
            f"stability margin of {model}": self._margin_excess(values, model, names)
            for model in STEP_NAMES
        }
        return violations(make_twin(values)) | margins

    def _margin_residual(
        self, values: Values, model: str, names: Iterable[str]
    ) -> float:
        return max(self._margin_excess(values, model, names), 0.0) / MARGIN_SCALE

    def _margin_excess(self, values: Values, model: str, names: Iterable[str]) -> float:
        found = self.corrections(values, model, names).values()
        return max(found, default=0.0) - MOST_CORRECTION


def error_residual(model: str, mse: float, target: Target) -> float:
    """Residual of a cell: log10 of ours over published, scaled.

    Its square grows like the deviation itself beyond one, so that a single cell that
    no twin can meet does not bend all the others (soft L1).
    """
    deviation = np.log10(mse / target.mse[model]) / LOG_SCALE[model]
    if not target.consistent[model]:
        deviation *= INCONSISTENT_WEIGHT
    return float(np.sign(deviation) * np.sqrt(2 * (np.hypot(1, deviation) - 1)))
