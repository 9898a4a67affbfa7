"""The start of an identified base, which effects show better than the base does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hystbench.blocks.starts import plainest_start, possible_starts
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.simulation.simulation import Simulation
from hystbench.gap.simulation.starting import starting
from hystbench.model import Model
from hystbench.record import Record


def begun_as_named(
    base: Model, found: ModelState, records: tuple[Record, ...]
) -> Model | None:
    """Give an identified base with the start that does best beside its effects.

    A base is identified with the gap in it. A mean that only a curve makes is then
    taken for what was before the records. Beside the curve it is seen as a slow motion
    of each record's own, which looks like drift.

    Parameters
    ----------
    base : Model
    found : ModelState
        The base with effects, among them a path of each record's own.
    records : tuple of Record
        The fit records, scored from their first sample on.

    Returns
    -------
    Model or None
        None where no record was given a path, or the base begins so already.
    """
    if not any(not values for _, values in found.beside):
        return None

    def left(start: str) -> float:
        chain = starting(found.chain, start)
        outputs = Simulation(chain, records, found.hold, "quick").output
        rests = (
            (record.y - y)[record.counted]
            for record, y in zip(records, outputs, strict=True)
        )
        return sum(float(np.sum(rest**2)) for rest in rests)

    starts = possible_starts(records)
    best = starts[plainest_start([left(start) for start in starts])]
    chain = starting(base.chain, best)
    return None if chain == base.chain else replace(base, chain=chain)
