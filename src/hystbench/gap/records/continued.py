"""Hold-out records that were cut from a file: what came just before is put back.

A record that is cut in two goes on in the middle of a motion. A model has to run over
the first part to know where the second begins.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from hystbench.dataset import Dataset
from hystbench.record import FloatArray, Mask, Record

OF_A_PART = frozenset({"rows", "use", "name", "meant", "stands_still", "missing"})
"""What dataset.yaml may say otherwise of another part of the same measurement."""


def continued(records: Sequence[Record], dataset: Dataset) -> list[Record]:
    """Put the record of the rows just before in front of each that is held out.

    Models run over it; scores leave it out. Records to fit stay as they are, so that
    nothing of what is held out comes into them. So do records in a steady state, which
    have a period of their own to begin with.

    Parameters
    ----------
    records : sequence of Record
        As they were read.
    dataset : Dataset
        Tells the files and the rows.
    """
    entries = [dataset.entry(record.name) for record in records]
    ends = {
        (_measurement(entry), entry["rows"][1]): record
        for entry, record in zip(entries, records, strict=True)
        if "rows" in entry
    }

    def with_past(record: Record, entry: Mapping[str, Any]) -> Record:
        first = entry.get("rows", (1,))[0]
        before = ends.get((_measurement(entry), first - 1))
        alike = before is not None and np.isclose(before.dt, record.dt, rtol=1e-4)
        if before is None or record.period_samples or not alike:
            return record
        return _behind(with_past(before, dataset.entry(before.name)), record)

    return [
        with_past(record, entry) if record.use == "hold-out" else record
        for entry, record in zip(entries, records, strict=True)
    ]


def _measurement(entry: Mapping[str, Any]) -> str:
    """Tell one measurement from others by what the entries of its parts share."""
    return repr(sorted((k, v) for k, v in entry.items() if k not in OF_A_PART))


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
        lead=len(before),
        past=len(before),
    )
