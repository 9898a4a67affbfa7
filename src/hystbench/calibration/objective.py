"""How far a twin and its step sizes are from the targets."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from hystbench.adaptive import make_filter
from hystbench.calibration.constraints import violations
from hystbench.calibration.targets import Target
from hystbench.calibration.twin import (
    STEP_NAMES,
    UNKNOWNS,
    Unknown,
    make_twin,
    step_sizes,
)
from hystbench.filters import MOST_CORRECTION
from hystbench.measurement import measure
from hystbench.model import Model
from hystbench.record import FloatArray, Record
from hystbench.signals import Signal
from hystbench.slow_loop import identify_slow_loop

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
    window_start_s : float
        Errors before it are left out of the MSE.
    unknowns : tuple of Unknown
        What is free.
    make : callable
        The twin that values of the unknowns make.
    loop : Signal, optional
        A slow signal, where the GPO filter has the envelopes that Algorithm 1 finds on
        it; otherwise they are the published ones.
    identification : mapping
        Settings of Algorithm 1, for a ``loop``.
    identified : mapping, optional
        What it found, as :meth:`at` puts it here.
    """

    signals: Mapping[str, Signal]
    filters: Mapping[str, Mapping[str, Any]]
    seed: int
    window_start_s: float = 0.0
    unknowns: tuple[Unknown, ...] = UNKNOWNS
    make: Callable[[dict[str, float]], Model] = make_twin
    loop: Signal | None = None
    identification: Mapping[str, Any] = field(default_factory=dict)
    identified: Mapping[str, Any] | None = None
    _records: dict[str, Record] = field(default_factory=dict, repr=False)
    _powers: dict[tuple[Any, ...], float] = field(default_factory=dict, repr=False)

    def record(self, name: str, model: Model, input_zero: float) -> Record:
        """Measure a signal on the twin as ``hystbench job measure`` does."""
        return self._measured(self.signals[name], model, {"input zero": input_zero})

    def _measured(
        self, signal: Signal, model: Model, values: Mapping[str, float]
    ) -> Record:
        settings = {
            "seed": self.seed,
            "input_zero_error": values.get("input zero", 0.0),
            "input_noise": values.get("input noise", 0.0),
        }
        return measure(signal, model, settings, "calibration")

    def at(self, values: Mapping[str, float]) -> Objective:
        """Give the objective with the envelopes that Algorithm 1 finds on a twin.

        Where the envelopes are the published ones, this is the objective itself.
        """
        if self.loop is None:
            return self
        slow = self._measured(self.loop, self.make(dict(values)), values)
        found = identify_slow_loop(slow, self.identification)
        return replace(self, identified=found.to_dict(), _powers={})

    def corrections(
        self, values: Mapping[str, float], model: str, names: Iterable[str]
    ) -> dict[str, float]:
        """Largest correction of a filter on some signals, 2 mu max|H|^2.

        It is the filter's stability margin; see
        :meth:`hystbench.filters.AdaptiveFilter.correction`. The records are those of
        the last :meth:`cells`.
        """
        settings = {
            **self.filters[model],
            "convergence_factor": step_sizes(dict(values))[model],
        }
        found = {}
        for name in names:
            record = self._records[name]
            adaptive = make_filter(model, settings, record, self.identified)
            # No plant and no step size changes the regressor: only the input does.
            recorded = (values.get("input zero", 0.0), values.get("input noise", 0.0))
            key = (model, name, *recorded)
            if key not in self._powers:
                self._powers[key] = adaptive.largest_power(record.u)
            found[name] = adaptive.correction(self._powers[key])
        return found

    def mse(self, model: str, record: Record, steps: Mapping[str, float]) -> float:
        """MSE of a filter on a record after the start of the window."""
        settings = {**self.filters[model], "convergence_factor": steps}
        adaptive = make_filter(model, settings, record, self.identified)
        result = adaptive.run(record.u, record.y)
        if result.diverged_at is not None:
            return DIVERGED
        start = round(self.window_start_s / record.dt)
        return float(np.mean(result.error[start:] ** 2))

    def cells(self, values: Mapping[str, float], names: Iterable[str]) -> Cells:
        """Errors of every filter on some signals."""
        twin, steps = self.make(dict(values)), step_sizes(dict(values))
        mse, rms = {}, {}
        for name in names:
            record = self._measured(self.signals[name], twin, values)
            self._records[name] = record
            start = round(self.window_start_s / record.dt)
            rms[name] = float(np.sqrt(np.mean(record.y[start:] ** 2)))
            mse[name] = {
                model: self.mse(model, record, steps[model]) for model in steps
            }
        return Cells(mse, rms)

    def residuals(
        self, values: Mapping[str, float], targets: tuple[Target, ...]
    ) -> FloatArray:
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
            for name, excess in violations(self.make(dict(values))).items()
        ]
        return np.array(out)

    def step_residuals(
        self, values: Mapping[str, float], targets: tuple[Target, ...], model: str
    ) -> FloatArray:
        """Give one filter's residuals on the records of the last :meth:`cells`.

        Its errors by signal, then its stability margin. A step size changes nothing
        else, so its column of the Jacobian is cheap.
        """
        steps = step_sizes(dict(values))[model]
        errors = [
            error_residual(
                model, self.mse(model, self._records[target.signal], steps), target
            )
            for target in targets
        ]
        names = [target.signal for target in targets]
        return np.array([*errors, self._margin_residual(values, model, names)])

    def _margin_residual(
        self, values: Mapping[str, float], model: str, names: Iterable[str]
    ) -> float:
        most = max(self.corrections(values, model, names).values(), default=0.0)
        return max(most - MOST_CORRECTION, 0.0) / MARGIN_SCALE


def error_residual(model: str, mse: float, target: Target) -> float:
    """Residual of a cell: log10 of ours over published, scaled.

    Its square grows like the deviation itself beyond one, so that a single cell that
    no twin can meet does not bend all the others (soft L1).
    """
    deviation = np.log10(mse / target.mse[model]) / LOG_SCALE[model]
    if not target.consistent[model]:
        deviation *= INCONSISTENT_WEIGHT
    return float(np.sign(deviation) * np.sqrt(2 * (np.hypot(1, deviation) - 1)))
