"""Records and runs of filters on a twin, all in memory.

A twin's thirteen records and the four filters on them take a tenth of a second. What
takes longer, and imports more, is in :mod:`hystbench.pressure.fits`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from hystbench.adaptive import make_filter, step_names
from hystbench.compare.evidence import Cell, Evidence, OrderPoint, Run
from hystbench.filters import AdaptiveFilter, Result, run_many
from hystbench.measurement import measure
from hystbench.metrics import mean_square_error, relative_error
from hystbench.order_errors import order_errors
from hystbench.pressure.twins import Twin
from hystbench.published import FILTERS
from hystbench.record import Record
from hystbench.signals import Signal, make_signal

Settings = Mapping[str, Any]
Steps = Mapping[str, float]
"""Factor on the configured step sizes of each filter."""


@dataclass(frozen=True)
class Ensemble:
    """What was run on one twin with one seed.

    Parameters
    ----------
    twin : Twin
    seed : int
        Added to the seeds of the sensor noise and of the random sum's phases.
    common : Evidence
        Records, identification and what else no step size changes.
    runs : dict
        Runs of a filter by its name and the factor on its step sizes.
    order_sweeps, envelope_errors : dict
        What Figure 7 and the two pairs of envelopes gave, by filter and factor, and
        by the GPO filter's factor.
    """

    twin: Twin
    seed: int
    common: Evidence
    runs: Mapping[tuple[str, float], Mapping[Cell, Run]]
    order_sweeps: Mapping[tuple[str, float], tuple[OrderPoint, ...]]
    envelope_errors: Mapping[float, Mapping[Cell, float]]

    def evidence(self, steps: Steps) -> Evidence:
        """Give all evidence with one choice of step sizes."""
        runs = dict(self.common.runs)
        sweep: list[OrderPoint] = []
        for model, factor in steps.items():
            runs |= self.runs[model, factor]
            sweep.extend(self.order_sweeps[model, factor])
        errors = self.envelope_errors.get(steps.get("gpo", math.nan), {})
        return replace(
            self.common,
            runs=runs,
            order_sweep=tuple(sweep),
            envelope_errors=errors,
        )


def draw_signals(definitions: Mapping[str, Settings], seed: int) -> dict[str, Signal]:
    """Make the signals; those with a seed of their own take another draw."""
    signals = {}
    for name, job in definitions.items():
        ((kind, given),) = job["definition"].items()
        if "seed" in given:
            given = given | {"seed": given["seed"] + seed}
        signals[name] = make_signal(name, {kind: given}, job["common"])
    return signals


def measure_twin(
    twin: Twin, signals: Iterable[Signal], settings: Settings, seed: int
) -> dict[str, Record]:
    """Simulate a twin on signals; another seed draws another noise."""
    job = dict(settings) | {"seed": settings["seed"] + seed}
    return {each.name: measure(each, twin.model, job, twin.place) for each in signals}


def filter_jobs(settings: Settings) -> dict[str, Settings]:
    """Give the settings of each filter, in the order of the paper's tables."""
    return {m: settings["filters"][m] for m in FILTERS if m in settings["filters"]}


def scaled(job: Settings, factor: float) -> dict[str, Any]:
    """Give a filter's settings with all its step sizes times a factor."""
    steps = {name: factor * mu for name, mu in job["convergence_factor"].items()}
    return dict(job) | {"convergence_factor": steps}


def run_records(
    model: str,
    job: Settings,
    records: Mapping[str, Record],
    identified: Settings,
) -> dict[Cell, Run]:
    """Run a filter on records; ``identified`` is the result of Algorithm 1."""
    filters = [make_filter(model, job, r, identified) for r in records.values()]
    errors = run_all(list(zip(filters, records.values(), strict=True)))
    return {
        (record.name, model): make_run(adaptive, record, *found)
        for adaptive, record, found in zip(
            filters, records.values(), errors, strict=True
        )
    }


def run_all(
    jobs: Sequence[tuple[AdaptiveFilter, Record]],
) -> list[tuple[float, float, Result]]:
    """Run filters on records; give MSE, RE (infinite where it diverged) and result."""
    results = run_many(((each, r.u, r.y) for each, r in jobs), workers=1)
    found = []
    for (_, record), result in zip(jobs, results, strict=True):
        if result.diverged_at is None:
            mse = mean_square_error(result.error)
            found.append((mse, relative_error(result.error, record.y), result))
        else:
            found.append((math.inf, math.inf, result))
    return found


def make_run(
    adaptive: AdaptiveFilter, record: Record, mse: float, re: float, result: Result
) -> Run:
    """Make the run of a filter; Eq. 19's bound and times, which cost more, are left."""
    at = result.diverged_at
    return Run(
        signal=record.name,
        model=adaptive.name,
        origin=record.origin,
        error_kind="one-step a priori",
        order=adaptive.order,
        weight_count=adaptive.size,
        step_size={
            name: getattr(adaptive, own)
            for name, own in step_names(adaptive.name).items()
        },
        bound={},
        diverged=None if at is None else f"diverged at sample {at}",
        mse=mse if at is None else None,
        re=re if at is None else None,
        mse_after_transient=None,
        re_after_transient=None,
        unit=f"{record.output.unit}^2",
        largest_eigenvalue=None,
        spread=None,
        convergence_s=None,
    )


def sweep_orders(
    record: Record, filters: Iterable[AdaptiveFilter], factor: float
) -> tuple[OrderPoint, ...]:
    """Run filters of several orders on a record, with a factor on their step sizes."""
    faster = []
    for each in filters:
        own = step_names(each.name).values()
        steps: dict[str, Any] = {name: factor * getattr(each, name) for name in own}
        faster.append(replace(each, **steps))
    return tuple(
        OrderPoint(each.model, each.order, math.inf if each.mse is None else each.mse)
        for each in order_errors(record, faster)
    )


def compare_envelopes(
    job: Settings, records: Mapping[str, Record], identified: Settings
) -> dict[Cell, float]:
    """Give the MSE of the GPO filter with either envelopes, by signal and envelopes."""
    errors = {}
    for source in ("identified", "published"):
        runs = run_records(
            "gpo", dict(job) | {"envelopes": source}, records, identified
        )
        for (signal, _), run in runs.items():
            errors[signal, source] = run.error("mse")
    return errors
