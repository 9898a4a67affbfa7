"""A case of any family from its spec, and as the files that a solver gets."""

from pathlib import Path
from typing import Any

import numpy as np

from hystbench.challenge.case import OUTPUT, Case, make_case
from hystbench.challenge.machine_case import make_machine_case
from hystbench.challenge.plant.effects import MACHINES
from hystbench.challenge.spec import CaseSpec
from hystbench.files import write_text
from hystbench.record import Record, column_name
from hystbench.yaml_files import yaml_text

#: Of an actuator; a machine's numbers have digits enough for its converter's steps.
ROW, ROW_OF_MACHINE = "%.6f,%.8f,%.3f\n", "%.6f,%.8g,%.7g\n"


def make(spec: CaseSpec) -> Case:
    """Make a case; the same spec gives the same numbers."""
    return make_machine_case(spec) if spec.family in MACHINES else make_case(spec)


def write_folder(case: Case, folder: Path) -> None:
    """Write what a solver gets, and nothing else: ``dataset/`` and ``model.yaml``.

    Parameters
    ----------
    case : Case
    folder : Path
        New or empty.
    """
    for record in case.records:
        write_text(folder / "dataset" / f"{record.name}.csv", _csv(record))
    if case.model is not None:
        write_text(folder / "model.yaml", case.model.to_yaml())
    write_text(folder / "dataset" / "dataset.yaml", _dataset(case))


def _csv(record: Record) -> str:
    table = np.stack([record.time, record.u, record.y], axis=1)
    row = ROW if record.output == OUTPUT else ROW_OF_MACHINE
    names = (column_name(c.name, c.unit) for c in (record.input, record.output))
    header = ",".join(["time_s", *names]) + "\n"
    return header + (row * len(table)) % tuple(table.ravel().tolist())


def _dataset(case: Case) -> str:
    entries = []
    for record in case.records:
        entry: dict[str, Any] = {"file": f"{record.name}.csv", "use": record.use}
        if record.period_samples is not None:
            entry["period_samples"] = record.period_samples
        entries.append(entry)
    given, measured = (
        {"column": column_name(channel.name, channel.unit), "unit": channel.unit}
        for channel in (case.records[0].input, case.records[0].output)
    )
    if case.records[0].output.name == "level":  # it has the unit of a length
        measured["quantity"] = "level"
    content = {
        "name": "blind-case",
        "description": "Made by hystbench hide: a simulation, no measurement.",
        "time": {"column": "time_s", "unit": "s"},
        "input": {**given, "hold": "band-limited"},
        "output": measured,
        "records": entries,
    }
    return yaml_text(content)
