"""All models on a twin, with step sizes around the configured ones.

Everything stays in memory: a twin's thirteen records and the four filters on them
take a tenth of a second.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from hystbench.adaptive import make_filter, step_names
from hystbench.compare.evidence import (
    Cell,
    Evidence,
    OrderPoint,
    Run,
    identification_of,
)
from hystbench.filters import AdaptiveFilter, Result, run_many
from hystbench.measurement import measure
from hystbench.metrics import mean_square_error, relative_error
from hystbench.order_errors import filters_by_order, order_errors
from hystbench.pressure.twins import Twin
from hystbench.published import FILTERS
from hystbench.rdgpi import RateDependentGPI, identify_rdgpi
from hystbench.record import Record
from hystbench.signals import Signal, make_signal
from hystbench.slow_loop import identify_slow_loop

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


def run_ensemble(
    twin: Twin,
    settings: Settings,
    rdgpi: RateDependentGPI | None,
    seed: int,
    factors: Sequence[float],
) -> Ensemble:
    """Run all models on a twin.

    Parameters
    ----------
    twin : Twin
    settings : mapping
        ``signals`` (definitions by name), ``asked`` (names of those to run),
        ``measure``, ``filters`` (settings by filter), ``identification`` (settings,
        ``signal`` among them) and ``order_sweep`` (the same).
    rdgpi : RateDependentGPI or None
        As :func:`fit_rdgpi` fits it: once a twin, for noise far below its error.
    seed : int
        Which draw of the noise and of the random sum; zero is the configured one.
    factors : sequence of float
        On the configured step sizes.
    """
    signals = draw_signals(settings["signals"], seed)
    records = measure_twin(twin, signals.values(), settings["measure"], seed)
    asked = {name: records[name] for name in settings["asked"]}
    jobs = filter_jobs(settings)
    found = identify_records(records, settings)
    runs = {
        (model, factor): run_records(model, scaled(job, factor), asked, found)
        for model, job in jobs.items()
        for factor in factors
    }
    sweep = settings["order_sweep"]
    swept = records[sweep["signal"]]
    by_order = {
        model: filters_by_order(swept, dict(sweep) | {"filters": {model: job}}, found)
        for model, job in jobs.items()
    }
    return Ensemble(
        twin=twin,
        seed=seed,
        common=Evidence(
            records=asked,
            identification=identification_of(found, twin.place),
            runs=run_rdgpi(rdgpi, asked),
        ),
        runs=runs,
        order_sweeps={
            (model, factor): sweep_orders(swept, filters, factor)
            for model, filters in by_order.items()
            for factor in factors
        },
        envelope_errors={
            factor: compare_envelopes(scaled(jobs["gpo"], factor), asked, found)
            for factor in factors
            if "gpo" in jobs
        },
    )


def step_choices(
    filters: Sequence[str], factors: Sequence[float], count: int, rng: Sequence[int]
) -> list[dict[str, float]]:
    """Draw choices of a factor for each filter; all of them where they are few.

    Parameters
    ----------
    filters : sequence of str
    factors : sequence of float
    count : int
        How many to draw, without repetition.
    rng : sequence of int
        Seed of the draw.
    """
    every = list(product(factors, repeat=len(filters)))
    if count < len(every):
        drawn = np.random.default_rng(rng).choice(len(every), count, replace=False)
        every = [every[index] for index in sorted(drawn)]
    return [dict(zip(filters, choice, strict=True)) for choice in every]


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


def fit_rdgpi(twin: Twin, settings: Settings) -> RateDependentGPI | None:
    """Fit the RDGPI model to a twin, or None where the settings leave it out."""
    job = settings["rdgpi"]
    if job is None:
        return None
    wanted = {name: settings["signals"][name] for name in job["fit_signals"]}
    signals = draw_signals(wanted, 0).values()
    return fit_rdgpi_records(
        measure_twin(twin, signals, settings["measure"], 0), settings
    )


def fit_rdgpi_records(
    records: Mapping[str, Record], settings: Settings
) -> RateDependentGPI | None:
    """Fit the RDGPI model to the records that its settings name."""
    job = settings["rdgpi"]
    if job is None:
        return None
    given = {key: value for key, value in job.items() if key != "fit_signals"}
    wanted = [records[name] for name in job["fit_signals"]]
    return identify_rdgpi(wanted, **given).model


def run_rdgpi(
    model: RateDependentGPI | None, records: Mapping[str, Record]
) -> dict[Cell, Run]:
    """Simulate the RDGPI model on records; nothing where there is none."""
    if model is None:
        return {}
    runs = {}
    for name, record in records.items():
        error = record.y - model.simulate(record.u, record.dt)
        runs[name, "rdgpi"] = Run(
            signal=name,
            model="rdgpi",
            origin=record.origin,
            error_kind="free-run simulation",
            order=None,
            weight_count=None,
            step_size={},
            bound={},
            diverged=None,
            mse=mean_square_error(error),
            re=relative_error(error, record.y),
            mse_after_transient=None,
            re_after_transient=None,
            unit=f"{record.output.unit}^2",
            largest_eigenvalue=None,
            spread=None,
            convergence_s=None,
        )
    return runs


def identify_records(
    records: Mapping[str, Record], settings: Settings
) -> dict[str, Any]:
    """Give the result of Algorithm 1 on the slow record, as its file holds it."""
    job = settings["identification"]
    return identify_slow_loop(records[job["signal"]], job).to_dict()


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
