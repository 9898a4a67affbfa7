"""Hold-out records that were cut from a file: what came just before is put back.

A record that is cut in two goes on in the middle of a motion. A model has to run over
the first part to know where the second begins.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hystbench.dataset import Dataset
from hystbench.errors import InputError
from hystbench.gap.records.pasts import is_steady, put_before
from hystbench.record import Record
from hystbench.units import seconds

HALF = 0.5
"""Share of a sampling interval by which the clock may be off between two parts."""


def continued(records: Sequence[Record], dataset: Dataset) -> list[Record]:
    """Put the records of the rows before in front of each that is held out.

    Models run over them; scores leave them out. The clock has to go on from one part to
    the next, where there is one. Records to fit stay as they are, so that nothing of
    what is held out comes into them. So do records in a steady state, whose own period
    is put before them.

    Parameters
    ----------
    records : sequence of Record
        As they were read.
    dataset : Dataset
        Tells the files, the rows and the times.

    Raises
    ------
    InputError
        If the input of a record is constant, with what is put in front of it too.
    """

    def with_past(record: Record) -> Record:
        if is_steady(record):
            return record
        names = dataset.just_before(record.name)
        before = [x for x in records if x.name in names]
        pasts = [with_past(x) for x in before if _goes_on(record, x, dataset)]
        longest = max(pasts, key=len, default=None)
        if longest is None:
            return record
        return replace(put_before(longest, record), period_samples=None)

    found = [
        with_past(record) if record.use == "hold-out" else record for record in records
    ]
    for record in found:
        if np.ptp(record.u) == 0:
            first, last = dataset.entry(record.name).get("rows", (1, len(record)))
            raise InputError(
                f"{dataset.record_files[record.name]}: record {record.name} (rows "
                f"{first} to {last}): its input is constant, and the time does not go "
                "on to it from the rows before; expected an input that moves"
            )
    return found


def _goes_on(record: Record, before: Record, dataset: Dataset) -> bool:
    """Tell whether a record begins where another one ends, one sample later."""
    if not np.isclose(before.dt, record.dt, rtol=1e-4):
        return False
    times, ended = (_times(x.name, dataset) for x in (record, before))
    if times is None or ended is None:
        return True
    return abs(times[0] - ended[1] - record.dt) <= HALF * record.dt


def _times(name: str, dataset: Dataset) -> tuple[float, float] | None:
    """Give the times of a record's first and last row in seconds, if it has any."""
    _, columns, rows = dataset.columns(name)
    if "time" not in columns:
        return None
    unit = seconds(f"{dataset.path}: time: unit", dataset.about["time"]["unit"])
    times = columns["time"].values[rows]
    return float(times[0]) * unit, float(times[-1]) * unit
