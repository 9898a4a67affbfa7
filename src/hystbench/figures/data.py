"""What figures are drawn from: records, runs with their arrays, parts of records."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hystbench.compare.evidence import Run, read_run
from hystbench.errors import InputError, refuse_unknown
from hystbench.record import FloatArray, Record, load_record


@dataclass(frozen=True)
class Output:
    """A run and its arrays, which end early where the run diverged."""

    run: Run
    """What ran on what, and its errors."""
    y: FloatArray
    error: FloatArray
    """Shape (samples,). Output of the model, and the record's output minus it."""


def read_one(records: Sequence[Path], which: str) -> Record:
    """Read the one record that a figure takes.

    Raises
    ------
    InputError
        If there is not one.
    """
    if len(records) != 1:
        raise InputError(f"{len(records)} records; expected {which}")
    return load_record(records[0])


def read_outputs(paths: Iterable[Path]) -> list[Output]:
    """Read runs and the arrays beside them (same name, ``.npz``).

    Raises
    ------
    InputError
        If the arrays are missing or no such archive.
    """
    outputs = []
    for path in paths:
        run, arrays = read_run(path), path.with_suffix(".npz")
        try:
            with np.load(arrays, allow_pickle=False) as archive:
                outputs.append(Output(run, archive["output"], archive["error"]))
        except (OSError, KeyError, ValueError) as error:
            raise InputError(f"{arrays}: not the arrays of a run ({error})") from error
    return outputs


def read_records(
    paths: Iterable[Path], runs: Sequence[Path]
) -> list[tuple[Record, list[Output]]]:
    """Read records, each with the runs on it.

    Raises
    ------
    InputError
        If a run is of none of the records, or a record has no run.
    """
    records = {record.name: record for record in map(load_record, paths)}
    found: dict[str, list[Output]] = {name: [] for name in records}
    for path, output in zip(runs, read_outputs(runs), strict=True):
        signal = output.run.signal
        refuse_unknown(signal, found, f"{path}: no record {signal!r}")
        found[signal].append(output)
    for name, outputs in found.items():
        if not outputs:
            raise InputError(f"record {name}: no run on it; expected one (--run)")
    return [(record, found[name]) for name, record in records.items()]


def read_pair(records: Sequence[Path], runs: Sequence[Path]) -> tuple[Record, Output]:
    """Read one record and the one run on it.

    Raises
    ------
    InputError
        If there is not one of each.
    """
    if len(records) != 1 or len(runs) != 1:
        raise InputError(
            f"{len(records)} records and {len(runs)} runs; expected one --record and "
            "one --run"
        )
    ((record, (output,)),) = read_records(records, runs)
    return record, output


def last_cycles(record: Record, cycles: int) -> slice:
    """Find the last full cycles of the input; all samples where it has fewer.

    A cycle starts where the input rises through its mean, having been clearly below
    it (by a tenth of its standard deviation, so that noise starts none).
    """
    moving = record.u - record.u.mean()
    side = np.sign(moving) * (np.abs(moving) > 0.1 * moving.std())
    places = np.flatnonzero(side)
    rises = places[1:][np.diff(side[places]) > 0]
    if len(rises) <= cycles:
        return slice(0, len(record))
    return slice(int(rises[-cycles - 1]), int(rises[-1]) + 1)


def last_seconds(record: Record, seconds: float) -> slice:
    """Find the end of a record; all samples where it is shorter."""
    return slice(max(0, len(record) - round(seconds / record.dt) - 1), len(record))
