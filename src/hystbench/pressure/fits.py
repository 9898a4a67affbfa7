"""What no step size changes on a twin: Algorithm 1 and the RDGPI model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from hystbench.compare.evidence import Cell, Run
from hystbench.metrics import mean_square_error, relative_error
from hystbench.pressure.runs import Settings, draw_signals, measure_twin
from hystbench.pressure.twins import Twin
from hystbench.rdgpi import RateDependentGPI, identify_rdgpi
from hystbench.record import Record
from hystbench.slow_loop import identify_slow_loop


def fit(twins: Sequence[Twin], settings: Settings) -> dict[str, dict[str, Any]]:
    """Run Algorithm 1 and the RDGPI model on each twin.

    Parameters
    ----------
    twins : sequence of Twin
    settings : mapping
        ``signals`` (definitions by name), ``asked`` (names of those to run),
        ``measure``, ``identification`` (settings, ``signal`` among them) and
        ``rdgpi`` (the same with ``fit_signals``, or None).
    """
    signals = draw_signals(settings["signals"], 0)
    part = {}
    for twin in twins:
        records = measure_twin(twin, signals.values(), settings["measure"], 0)
        asked = {name: records[name] for name in settings["asked"]}
        rdgpi = run_rdgpi(fit_rdgpi_records(records, settings), asked)
        part[twin.name] = {
            "identified": identify_records(records, settings),
            "runs": [asdict(run) for run in rdgpi.values()],
        }
    return part


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
