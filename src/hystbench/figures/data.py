"""What figures are drawn from: records, runs with their arrays, parts of records."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hystbench.compare.runs import Run, read_run
from hystbench.record import FloatArray, Record, load_record
from hystbench.written import check_unchanged


@dataclass(frozen=True)
class Output:
    """A run and its arrays, which end early where the run diverged."""

    run: Run
    """What ran on what, and its errors."""
    y: FloatArray
    error: FloatArray
    """Shape (samples,). Output of the model, and the record's output minus it."""


def read_records(
    paths: Iterable[Path], runs: Iterable[Path]
) -> list[tuple[Record, list[Output]]]:
    """Read records, each with the runs on it.

    The arrays of a run lie beside it (same name, ``.npz``).

    Raises
    ------
    InputError
        If one of them was changed since hystbench wrote it.
    """
    outputs = []
    for path in runs:
        beside = path.with_suffix(".npz")
        check_unchanged(beside)
        with np.load(beside, allow_pickle=False) as arrays:
            outputs.append(Output(read_run(path), arrays["output"], arrays["error"]))
    return [
        (record, [each for each in outputs if each.run.signal == record.name])
        for record in map(load_record, paths)
    ]


def read_pair(records: Sequence[Path], runs: Sequence[Path]) -> tuple[Record, Output]:
    """Read one record and the one run on it."""
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
