"""A case as files: the solver's folder, and the truth anywhere but in it."""

from pathlib import Path
from typing import Any

import numpy as np

from hystbench.challenge.base import OUTPUT
from hystbench.challenge.case import Case
from hystbench.errors import InputError
from hystbench.files import whole_folder, write_json, write_text
from hystbench.record import Record, column_name

#: Of an actuator; a machine's numbers have digits enough for its converter's steps.
ROW, ROW_OF_MACHINE = "%.6f,%.8f,%.3f\n", "%.6f,%.8g,%.7g\n"


def write_case(case: Case, folder: str | Path, truth_file: str | Path) -> None:
    """Write ``dataset/`` and ``model.yaml`` into a folder, and the truth elsewhere.

    Without a base there is no ``model.yaml``: the solver is to identify a linear one.

    Parameters
    ----------
    case : Case
    folder : str or Path
        New or empty.
    truth_file : str or Path
        JSON, outside the folder.

    Raises
    ------
    InputError
        As :func:`check_places`.
    """
    folder, truth_file = Path(folder), Path(truth_file)
    check_places(folder, truth_file)
    # The folder comes last: next time it would be refused, as it would not be empty.
    write_json(truth_file, case.truth)
    with whole_folder(folder, ()) as fresh:
        write_folder(case, fresh)


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


def check_places(folder: Path, truth_file: Path) -> None:
    """Refuse places before anything is made.

    Raises
    ------
    InputError
        If the truth would lie in the folder, or the folder holds something.
    """
    if truth_file.resolve().is_relative_to(folder.resolve()):
        raise InputError(
            f"{truth_file}: truth inside {folder}; expected a file outside the folder "
            "that the solver gets"
        )
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(f"{folder}: expected a new or an empty folder")


def _csv(record: Record) -> str:
    table = np.stack([record.time, record.u, record.y], axis=1)
    row = ROW if record.output == OUTPUT else ROW_OF_MACHINE
    names = (column_name(c.name, c.unit) for c in (record.input, record.output))
    header = ",".join(["time_s", *names]) + "\n"
    return header + (row * len(table)) % tuple(table.ravel().tolist())


def _dataset(case: Case) -> str:
    import yaml  # late: not needed for cases in memory

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
    text: str = yaml.safe_dump(content, sort_keys=False, default_flow_style=None)
    return text
