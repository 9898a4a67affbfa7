"""Hold-out records that were cut from a file: what came just before is put back.

A record that is cut in two goes on in the middle of a motion. A model has to run over
the first part to know where the second begins.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from hystbench.dataset import Dataset
from hystbench.gap.records.pasts import is_steady
from hystbench.record import FloatArray, Mask, Record
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
        return record if longest is None else _behind(longest, record)

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
    times: tuple[float, float] | None
    """Of the first and the last row, in seconds from a clock's zero."""

    @classmethod
    def of(cls, record: Record, dataset: Dataset) -> _Part:
        entry = dataset.entry(record.name)
        own = sorted((k, v) for k, v in entry.items() if k not in OF_A_PART)
        first, last = entry.get("rows", (1, None))
        times = _times(record.name, dataset) if "rows" in entry else None
        return cls(record, repr(own), first, last, times)

    def follows(self, other: _Part) -> bool:
        """Tell whether this part begins where another one ends, one sample later."""
        dt = self.record.dt
        if self.measurement != other.measurement or self.first - 1 != other.last:
            return False
        if not np.isclose(other.record.dt, dt, rtol=1e-4):
            return False
        if self.times is None or other.times is None:
            return True
        return abs(self.times[0] - other.times[1] - dt) <= HALF * dt


def _times(name: str, dataset: Dataset) -> tuple[float, float] | None:
    """Give the times of a record's first and last row in seconds, if it has any."""
    _, columns, rows = dataset.columns(name)
    if "time" not in columns:
        return None
    unit = seconds(f"{dataset.path}: time: unit", dataset.about["time"]["unit"])
    times = columns["time"].values[rows]
    return float(times[0]) * unit, float(times[-1]) * unit


def _behind(before: Record, record: Record) -> Record:
    u, y = ([before.u, record.u], [before.y, record.y])
    simulated: FloatArray | None = None
    if before.simulated is not None and record.simulated is not None:
        simulated = np.concatenate([before.simulated, record.simulated])
    interpolated: Mask | None = None
    if before.interpolated is not None or record.interpolated is not None:
        lost = [
            np.zeros(len(x), dtype=bool) if x.interpolated is None else x.interpolated
            for x in (before, record)
        ]
        interpolated = np.concatenate(lost)
    return replace(
        record,
        u=np.concatenate(u),
        y=np.concatenate(y),
        simulated=simulated,
        interpolated=interpolated,
        period_samples=None,
        lead=len(before),
        past=len(before),
    )
