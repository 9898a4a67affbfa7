"""All models on each twin, in parts that can be made again alone.

Each twin is run as configured and in other experiments
(:mod:`hystbench.pressure.experiments`).

What no step size changes takes the most time and is one part
(:func:`hystbench.pressure.fits.fit`); each filter (:func:`run`) is another. The parts
are JSON; :func:`join` puts them together. Each simulates the records that it needs:
kept in files, those of all twins would be a hundred megabytes.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from typing import Any

from hystbench.compare.evidence import Evidence, OrderPoint, Run, identification_of
from hystbench.errors import InputError, nearest
from hystbench.order_errors import filters_by_order
from hystbench.pressure.experiments import Experiment, experiments, within_margin
from hystbench.pressure.runs import (
    Ensemble,
    Settings,
    compare_envelopes,
    draw_signals,
    filter_jobs,
    measure_twin,
    run_records,
    sweep_orders,
)
from hystbench.pressure.twins import Twin
from hystbench.record import Record
from hystbench.signals import Signal

Part = dict[str, dict[str, Any]]
"""What was found on each twin, by its name."""


def run(twins: Sequence[Twin], settings: Settings, fitted: Part) -> Part:
    """Run one filter on each twin: the signals, Figure 7 and both envelopes.

    Parameters
    ----------
    twins : sequence of Twin
    settings : mapping
        ``signals``, ``asked`` and ``measure`` as for
        :func:`hystbench.pressure.fits.fit`; ``filters``, with the settings of the
        one filter; ``order_sweep``; ``experiments``, as
        :func:`hystbench.pressure.experiments.experiments` takes them; and
        ``calibrated``, the signals on which a step size keeps its margin.
    fitted : mapping
        What :func:`hystbench.pressure.fits.fit` found.

    Raises
    ------
    InputError
        If a twin was not fitted.
    """
    signals = draw_signals(settings["signals"], 0)
    ((model, job),) = filter_jobs(settings).items()
    sweep = settings["order_sweep"]
    by_order = None
    part: Part = {}
    for place, twin in enumerate(twins):
        found = _of(fitted, twin)["identified"]
        records = measure_twin(twin, signals.values(), settings["measure"], 0)
        asked = {name: records[name] for name in settings["asked"]}
        swept = records[sweep["signal"]]
        # All twins have one input, so Eq. 19's bounds, which take time, are the same
        # unless the regressor follows what was identified on the twin.
        if by_order is None or job.get("envelopes") == "identified":
            orders = dict(sweep) | {"filters": {model: job}}
            by_order = filters_by_order(swept, orders, found)
        part[twin.name] = {
            **_on_records(model, job, asked, found),
            "experiments": [
                _in_experiment(model, job, twin, settings, each, found)
                for each in experiments(settings["experiments"], place)
            ],
            "order_sweep": [
                [point.model, point.order, _finite(point.mse)]
                for point in sweep_orders(swept, by_order, 1.0)
            ],
        }
    return part


def _on_records(
    model: str, job: Settings, records: Mapping[str, Record], found: Settings
) -> dict[str, Any]:
    """Run one filter on records, and with both envelopes if it has them."""
    envelopes = compare_envelopes(job, records, found) if model == "gpo" else {}
    runs = run_records(model, job, records, found).values()
    return {
        "runs": [asdict(each) for each in runs],
        "envelope_errors": [[*cell, _finite(e)] for cell, e in envelopes.items()],
    }


def _in_experiment(
    model: str,
    job: Settings,
    twin: Twin,
    settings: Settings,
    experiment: Experiment,
    found: Settings,
) -> dict[str, Any]:
    asked = {name: settings["signals"][name] for name in settings["asked"]}
    signals = draw_signals(asked, experiment.seed).values()
    measured = experiment.measured(settings["measure"])
    records = measure_twin(twin, signals, measured, experiment.seed)
    known = [records[name] for name in settings["calibrated"] if name in records]
    factor = experiment.steps[model]
    chosen = within_margin(model, job, factor, known, found)
    return _on_records(model, chosen, records, found)


def join(
    twin: Twin, signals: Iterable[Signal], settings: Settings, parts: Sequence[Part]
) -> Ensemble:
    """Put the parts of one twin as configured together; the first is what was fitted.

    Raises
    ------
    InputError
        If a part does not hold the twin.
    """
    fitted, *filters = [_of(part, twin) for part in parts]
    records = measure_twin(twin, signals, settings["measure"], 0)
    return _joined(twin, 0, records, fitted, filters, filters)


def join_experiments(
    twin: Twin, place: int, settings: Settings, parts: Sequence[Part]
) -> list[Ensemble]:
    """Put the parts of one twin in its other experiments together.

    What was fitted, and Figure 7, are as configured: no experiment changes them.
    """
    fitted, *filters = [_of(part, twin) for part in parts]
    asked = {name: settings["signals"][name] for name in settings["asked"]}
    found = []
    for number, each in enumerate(experiments(settings["experiments"], place)):
        signals = draw_signals(asked, each.seed).values()
        measured = each.measured(settings["measure"])
        records = measure_twin(twin, signals, measured, each.seed)
        own = [part["experiments"][number] for part in filters]
        found.append(_joined(twin, each.seed, records, fitted, own, filters))
    return found


def _joined(
    twin: Twin,
    seed: int,
    records: Mapping[str, Record],
    fitted: dict[str, Any],
    filters: Sequence[dict[str, Any]],
    swept: Sequence[dict[str, Any]],
) -> Ensemble:
    common = Evidence(
        records=records,
        identification=identification_of(fitted["identified"], twin.place),
        runs=_runs(fitted),
    )
    models = [each["runs"][0]["model"] for each in filters]
    return Ensemble(
        twin=twin,
        seed=seed,
        common=common,
        runs={
            (model, 1.0): _runs(each)
            for model, each in zip(models, filters, strict=True)
        },
        order_sweeps={
            (model, 1.0): tuple(
                OrderPoint(name, order, _infinite(mse))
                for name, order, mse in each["order_sweep"]
            )
            for model, each in zip(models, swept, strict=True)
        },
        envelope_errors={
            1.0: {
                (signal, source): _infinite(error)
                for each in filters
                for signal, source, error in each["envelope_errors"]
            }
        },
    )


def _of(part: Mapping[str, dict[str, Any]], twin: Twin) -> dict[str, Any]:
    if twin.name not in part:
        raise InputError(f"{twin.place}: not run; {nearest(twin.name, part)}")
    return part[twin.name]


def _runs(content: Mapping[str, Any]) -> dict[tuple[str, str], Run]:
    runs = [Run(**given) for given in content["runs"]]
    return {(run.signal, run.model): run for run in runs}


def _finite(error: float) -> float | None:
    """JSON has no infinity: a diverged run's error is none."""
    return error if math.isfinite(error) else None


def _infinite(error: float | None) -> float:
    return math.inf if error is None else error
