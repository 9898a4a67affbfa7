"""All models on each twin as configured, in parts that can be made again alone.

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
        one filter; and ``order_sweep``.
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
    for twin in twins:
        found = _of(fitted, twin)["identified"]
        records = measure_twin(twin, signals.values(), settings["measure"], 0)
        asked = {name: records[name] for name in settings["asked"]}
        swept = records[sweep["signal"]]
        # All twins have one input, so Eq. 19's bounds, which take time, are the same
        # unless the regressor follows what was identified on the twin.
        if by_order is None or job.get("envelopes") == "identified":
            orders = dict(sweep) | {"filters": {model: job}}
            by_order = filters_by_order(swept, orders, found)
        envelopes = compare_envelopes(job, asked, found) if model == "gpo" else {}
        part[twin.name] = {
            "runs": [asdict(r) for r in run_records(model, job, asked, found).values()],
            "order_sweep": [
                [point.model, point.order, _finite(point.mse)]
                for point in sweep_orders(swept, by_order, 1.0)
            ],
            "envelope_errors": [[*cell, _finite(e)] for cell, e in envelopes.items()],
        }
    return part


def join(
    twin: Twin, signals: Iterable[Signal], settings: Settings, parts: Sequence[Part]
) -> Ensemble:
    """Put the parts of one twin together; the first is what was fitted.

    Raises
    ------
    InputError
        If a part does not hold the twin.
    """
    fitted, *filters = [_of(part, twin) for part in parts]
    common = Evidence(
        records=measure_twin(twin, signals, settings["measure"], 0),
        identification=identification_of(fitted["identified"], twin.place),
        runs=_runs(fitted),
    )
    models = [each["runs"][0]["model"] for each in filters]
    return Ensemble(
        twin=twin,
        seed=0,
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
            for model, each in zip(models, filters, strict=True)
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
