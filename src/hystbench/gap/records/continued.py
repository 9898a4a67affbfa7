"""Hold-out records that were cut from a file: what came just before is put back.

A record that is cut in two goes on in the middle of a motion. A model has to run over
the first part to know where the second begins.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from hystbench.dataset import Dataset
from hystbench.gap.records.pasts import is_steady, put_before
from hystbench.record import Record
from hystbench.units import seconds

OF_A_PART = frozenset(
    {"rows", "use", "name", "meant", "stands_still", "missing", "period_samples"}
)
"""What dataset.yaml may say otherwise of another part of the same measurement."""
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
    """
    parts = [_Part.of(record, dataset) for record in records]

    def with_past(part: _Part) -> Record:
        record = part.record
        if is_steady(record):
            return record
        pasts = [with_past(x) for x in parts if part.follows(x)]
        longest = max(pasts, key=len, default=None)
        if longest is None:
            return record
        return replace(put_before(longest, record), period_samples=None)

    return [
        with_past(part) if part.record.use == "hold-out" else part.record
        for part in parts
    ]


@dataclass(frozen=True)
class _Part:
    """A record, and where in a measurement it was."""

    record: Record
    measurement: str
    first: int
    """Row, counted from 1."""
    last: int | None
    """None where no rows are told: nothing follows."""
    dataset: Dataset

    @classmethod
    def of(cls, record: Record, dataset: Dataset) -> _Part:
        entry = dataset.entry(record.name)
        own = sorted((k, v) for k, v in entry.items() if k not in OF_A_PART)
        first, last = entry.get("rows", (1, None))
        return cls(record, repr(own), first, last, dataset)

    def follows(self, other: _Part) -> bool:
        """Tell whether this part begins where another one ends, one sample later."""
        dt = self.record.dt
        if self.measurement != other.measurement or self.first - 1 != other.last:
            return False
        if not np.isclose(other.record.dt, dt, rtol=1e-4):
            return False
        times, before = (_times(x.record.name, x.dataset) for x in (self, other))
        if times is None or before is None:
            return True
        return abs(times[0] - before[1] - dt) <= HALF * dt


def _times(name: str, dataset: Dataset) -> tuple[float, float] | None:
    """Give the times of a record's first and last row in seconds, if it has any."""
    _, columns, rows = dataset.columns(name)
    if "time" not in columns:
        return None
    unit = seconds(f"{dataset.path}: time: unit", dataset.about["time"]["unit"])
    times = columns["time"].values[rows]
    return float(times[0]) * unit, float(times[-1]) * unit
