"""All models on each twin, in parts that can be made again alone.

Each twin is run as configured and in other experiments
(:mod:`hystbench.twins.experiments`). What no step size changes takes the most time and
is one part (:func:`hystbench.twins.fits.fit`); each filter (:func:`run`) is another.
The parts are JSON; :func:`join` puts them together. Each simulates the records that it
needs: kept in files, those of all twins would be a hundred megabytes.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from hystbench.compare.evidence import ClaimEvidence, Run
from hystbench.errors import refuse_unknown
from hystbench.files import finite_or_none
from hystbench.order_errors import OrderError, filters_by_order, order_errors
from hystbench.record import Record
from hystbench.twins.experiments import (
    CONFIGURED,
    TwinExperiment,
    experiments,
    within_margin,
)
from hystbench.twins.read import Twin
from hystbench.twins.runs import (
    Settings,
    compare_envelopes,
    draw_signals,
    filter_jobs,
    measure_twin,
    run_records,
)

Part = dict[str, dict[str, Any]]
"""What was found on each twin, by its name."""


@dataclass(frozen=True)
class TwinOutcome:
    """What was found on one twin in one experiment."""

    twin: Twin
    experiment: TwinExperiment
    evidence: ClaimEvidence


def run(twins: Sequence[Twin], settings: Settings, fitted: Part) -> Part:
    """Run one filter on each twin: the signals, Figure 7 and both envelopes.

    Parameters
    ----------
    twins : sequence of Twin
    settings : mapping
        ``signals``, ``asked`` and ``measure`` as for :func:`hystbench.twins.fits.fit`;
        ``filters``, with the settings of the one filter; ``order_sweep``;
        ``experiments``, as :func:`hystbench.twins.experiments.experiments` takes them;
        and ``calibrated``, the signals on which a step size keeps its margin.
    fitted : mapping
        What :func:`hystbench.twins.fits.fit` found.

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
        swept = records[sweep["signal"]]
        # All twins have one input, so Eq. 19's bounds, which take time, are the same
        # unless the regressor follows what was identified on the twin.
        if by_order is None or job.get("envelopes") == "identified":
            orders = dict(sweep) | {"filters": {model: job}}
            by_order = filters_by_order(swept, orders, found)
        asked = {name: records[name] for name in settings["asked"]}
        others = []
        for each in experiments(settings["experiments"], place):
            measured = records_of(twin, each, settings)
            known = [
                r for name, r in measured.items() if name in settings["calibrated"]
            ]
            chosen = within_margin(model, job, each.steps[model], known, found)
            others.append(_on_records(model, chosen, measured, found))
        part[twin.name] = {
            **_on_records(model, job, asked, found),
            "experiments": others,
            "order_sweep": [
                [point.model, point.order, finite_or_none(point.mse)]
                for point in order_errors(swept, by_order)
            ],
        }
    return part


def records_of(
    twin: Twin, experiment: TwinExperiment, settings: Settings
) -> dict[str, Record]:
    """Measure the signals that are asked for on a twin in an experiment."""
    asked = {name: settings["signals"][name] for name in settings["asked"]}
    signals = draw_signals(asked, experiment.seed).values()
    measured = experiment.measured(settings["measure"])
    return measure_twin(twin, signals, measured, experiment.seed)


def join(
    twin: Twin, place: int, settings: Settings, parts: Sequence[Part]
) -> list[TwinOutcome]:
    """Put the parts of one twin together: as configured, then each other experiment.

    What was fitted, and Figure 7, are as configured: no experiment changes them.

    Parameters
    ----------
    twin : Twin
    place : int
        Which of the twins it is.
    settings : mapping
        ``signals``, ``asked``, ``measure`` and ``experiments``.
    parts : sequence of dict
        What was fitted, then what each filter did.

    Raises
    ------
    InputError
        If a part does not hold the twin.
    """
    fitted, *filters = [_of(part, twin) for part in parts]
    every = [CONFIGURED, *experiments(settings["experiments"], place)]
    found = []
    for number, experiment in enumerate(every):
        own = [[each, *each["experiments"]][number] for each in filters]
        evidence = ClaimEvidence(
            records=records_of(twin, experiment, settings),
            identification=fitted["identified"],
            runs={
                (given["signal"], given["model"]): Run(**given)
                for each in (fitted, *own)
                for given in each["runs"]
            },
            order_sweep=tuple(
                OrderError(name, order, _infinite(mse))
                for each in filters
                for name, order, mse in each["order_sweep"]
            ),
            envelope_errors={
                (signal, source): _infinite(error)
                for each in own
                for signal, source, error in each["envelope_errors"]
            },
        )
        found.append(TwinOutcome(twin, experiment, evidence))
    return found


def _on_records(
    model: str, job: Settings, records: Mapping[str, Record], found: Settings
) -> dict[str, Any]:
    """Run one filter on records, and with both envelopes if it has them."""
    envelopes = compare_envelopes(job, records, found) if model == "gpo" else {}
    runs = run_records(model, job, records, found).values()
    return {
        "runs": [asdict(each) for each in runs],
        "envelope_errors": [
            [*cell, finite_or_none(e)] for cell, e in envelopes.items()
        ],
    }


def _of(part: Mapping[str, dict[str, Any]], twin: Twin) -> dict[str, Any]:
    refuse_unknown(twin.name, part, f"{twin.place}: not run")
    return part[twin.name]


def _infinite(error: float | None) -> float:
    return math.inf if error is None else error
