"""``hystbench simulate``: run a model on one record."""

import zipfile
from pathlib import Path
from typing import Annotated, NamedTuple

import click
import numpy as np

from hystbench import options
from hystbench.blocks.held import Hold
from hystbench.dataset import load_dataset
from hystbench.errors import InputError, nearest
from hystbench.files import write_columns
from hystbench.model import check_bounded, load_model
from hystbench.options import In, Out, command
from hystbench.record import Channel, FloatArray, Record, column_name, load_record
from hystbench.samples import read_input
from hystbench.signals import load_signal
from hystbench.units import check_same_unit


class SimulationTask(NamedTuple):
    """What is to be simulated, and the record if anything was measured."""

    dt: float
    u: FloatArray
    input: Channel
    hold: Hold | None = None
    record: Record | None = None
    column: str | None = None


@command
def simulate(
    model: In,
    record: In,
    *,
    dataset: Annotated[
        Path | None,
        options.DATASET,
        "The dataset.yaml of a CSV record; by default the one beside it.",
    ] = None,
    hold: Annotated[
        Hold | None, "How the input moves between samples where MODEL does not say."
    ] = None,
    out: Out,
) -> None:
    """Run MODEL on RECORD and write time, input, measured and simulated output.

    RECORD is a file of a dataset, or an archive (.npz) of a record or a signal; or
    a CSV file of one's own, with no dataset.yaml beside it, of two columns: time_s and
    the model's input, named with its unit, such as current_A.
    """
    system = load_model(model)
    task = _read(record, dataset, system.input)
    measured = None if task.record is None else task.record.output
    pairs = [("input", system.input, task.input), ("output", system.output, measured)]
    for side, ours, theirs in pairs:
        if theirs is not None:
            place = f"{model}: {side}: unit"
            check_same_unit(place, ours.unit, str(record), theirs.unit, of_model=True)
    taken = hold or task.hold
    if taken is not None:
        system = system.with_hold(taken)
    if task.record is not None:
        system = system.with_records([task.record], task.column)
        system = system.begun_on(task.record)
    y = system.simulate(task.u, task.dt)
    check_bounded(str(model), y, task.dt, str(record))
    time = np.arange(len(y)) * task.dt
    columns = {"time_s": time, column_name(task.input.name, task.input.unit): task.u}
    if task.record is not None:
        columns[column_name("measured", task.record.output.unit)] = task.record.y
    unit = (measured or system.output).unit  # one unit, in the record's spelling
    columns[column_name("simulated", unit)] = y
    write_columns(out, columns)
    click.echo(
        f"{out}: {len(y)} samples; hold where the model sets none: "
        f"{taken or 'each block its default'}"
    )


def _read(record: Path, dataset: Path | None, expected: Channel) -> SimulationTask:
    if record.suffix != ".npz":
        return _read_file(record, dataset, expected)
    if dataset is not None:
        raise InputError(f"{record}: an archive; expected no --dataset with it")
    if _names(record) >= {"name", "dt", "u", "unit"}:
        signal = load_signal(record)
        given = Channel("input", signal.unit)
        return SimulationTask(signal.dt, signal.u, given)
    found = load_record(record)
    return SimulationTask(found.dt, found.u, found.input, record=found)


def _read_file(record: Path, dataset: Path | None, expected: Channel) -> SimulationTask:
    beside = record.parent / "dataset.yaml"
    if dataset is None and not beside.is_file():
        dt, u = read_input(record, column_name(expected.name, expected.unit))
        return SimulationTask(dt, u, expected)
    about = load_dataset(dataset or beside)
    names = [
        name
        for name, file in about.record_files.items()
        if file.resolve() == record.resolve()
    ]
    if len(names) > 1:
        raise InputError(
            f"{about.path}: records: {record} holds {', '.join(names)}; expected one: "
            f"take it out with 'hystbench load {about.path} {names[0]} --out "
            f"{names[0]}.npz' and simulate that"
        )
    if names:
        found = about.read(names[0])
        own = found.dt, found.u, found.input, about.input_hold
        return SimulationTask(*own, found, about.simulated_column)
    files = [file.name for file in about.record_files.values()]
    raise InputError(
        f"{about.path}: records: {record} is none of them; "
        f"{nearest(record.name, files)}"
    )


def _names(archive: Path) -> set[str]:
    """Name the arrays of a NumPy archive."""
    try:
        with zipfile.ZipFile(archive) as content:
            return {Path(name).stem for name in content.namelist()}
    except (OSError, zipfile.BadZipFile) as error:
        raise InputError(f"{archive}: not an archive of NumPy ({error})") from error
