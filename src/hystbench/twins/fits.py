"""What no step size changes on a twin: Algorithm 1 and the RDGPI model."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from hystbench.compare.runs import Cell, Run
from hystbench.identification.algorithm import identify_slow_loop
from hystbench.rdgpi import RateDependentGPI, identify_rdgpi
from hystbench.record import Record
from hystbench.twins.runs import (
    Settings,
    Twin,
    bare_run,
    draw_signals,
    measure_twin,
)


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
    job = settings["identification"]
    part = {}
    for twin in twins:
        records = measure_twin(twin, signals.values(), settings["measure"], 0)
        asked = {name: records[name] for name in settings["asked"]}
        rdgpi = run_rdgpi(_fit_rdgpi(records, settings["rdgpi"]), asked)
        part[twin.name] = {
            "identified": identify_slow_loop(records[job["signal"]], job).to_dict(),
            "runs": [asdict(run) for run in rdgpi.values()],
        }
    return part


def run_rdgpi(
    model: RateDependentGPI | None, records: Mapping[str, Record]
) -> dict[Cell, Run]:
    """Simulate the RDGPI model on records; nothing where there is none."""
    if model is None:
        return {}
    return {
        (name, "rdgpi"): bare_run(
            record,
            "rdgpi",
            record.y - model.simulate(record.u, record.dt),
            error_kind="free-run simulation",
        )
        for name, record in records.items()
    }


def _fit_rdgpi(
    records: Mapping[str, Record], job: Settings | None
) -> RateDependentGPI | None:
    if job is None:
        return None
    given = {key: value for key, value in job.items() if key != "fit_signals"}
    wanted = [records[name] for name in job["fit_signals"]]
    return identify_rdgpi(wanted, **given).model
