"""All models on each twin, in parts that can be made again alone.

Each twin is run as configured and in other experiments that are drawn: step sizes, zero
error, noise and phases, which the paper leaves open. What no step size changes takes
the most time and is one part (:func:`hystbench.twins.fits.fit`); each filter
(:func:`run`) is another.
The parts are JSON; :func:`join` puts them together. Each simulates the records that it
needs: kept in files, those of all twins would be a hundred megabytes.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from hystbench.adaptive import make_filter
from hystbench.compare.runs import ClaimEvidence, Run
from hystbench.errors import refuse_unknown
from hystbench.files import finite_or_none
from hystbench.filters import MOST_CORRECTION
from hystbench.order_errors import OrderError, filters_by_order, order_errors
from hystbench.published import FILTERS
from hystbench.record import Record
from hystbench.twins.runs import (
    Settings,
    Twin,
    compare_envelopes,
    draw_signals,
    filter_jobs,
    measure_twin,
    run_records,
)

Part = dict[str, dict[str, Any]]
"""What was found on each twin, by its name."""


@dataclass(frozen=True)
class TwinExperiment:
    """What is changed in an experiment."""

    seed: int
    """Draw of the noise and of the random sum's phases; 0 is the configured one."""
    steps: dict[str, float]
    """Factor on the step sizes of each filter."""
    zero: float
    noise: float
    """Factors on the zero error and on the noise of the recorded input."""

    def measured(self, settings: Settings) -> dict[str, Any]:
        """Give the settings of the measurement with zero error and noise changed."""
        factors = {"input_zero_error": self.zero, "input_noise": self.noise}
        return dict(settings) | {
            key: factor * settings[key] for key, factor in factors.items()
        }


CONFIGURED = TwinExperiment(0, dict.fromkeys(FILTERS, 1.0), 1.0, 1.0)
"""The experiment of config.yaml."""


def experiments(design: Settings, place: int) -> list[TwinExperiment]:
    """Draw the other experiments of a twin.

    Parameters
    ----------
    design : mapping
        ``members`` (how many), ``step_factors``, ``zero_factors``, ``noise_factors``.
    place : int
        Which twin it is: each has draws of its own.
    """
    found = []
    for number in range(1, design["members"] + 1):
        rng = np.random.default_rng([place, number])
        drawn = rng.choice(design["step_factors"], len(FILTERS))
        found.append(
            TwinExperiment(
                seed=place * design["members"] + number,
                steps=dict(zip(FILTERS, map(float, drawn), strict=True)),
                zero=float(rng.choice(design["zero_factors"])),
                noise=float(rng.choice(design["noise_factors"])),
            )
        )
    return found


def within_margin(
    model: str,
    job: Settings,
    factor: float,
    records: Iterable[Record],
    identified: Mapping[str, Any],
) -> dict[str, Any]:
    """Scale a filter's step sizes, but not beyond the margin on any of some records.

    The margin is that of the calibration: an experimenter would have seen a filter
    beyond it grow without end.
    """
    most = 0.0
    for record in records:
        adaptive = make_filter(model, job, record, identified)
        most = max(most, adaptive.correction(adaptive.largest_power(record.u)))
    times = min(factor, MOST_CORRECTION / most) if most else factor
    steps = {name: times * mu for name, mu in job["convergence_factor"].items()}
    return {**job, "convergence_factor": steps}


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
        ``experiments``, as :func:`experiments` takes them;
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
