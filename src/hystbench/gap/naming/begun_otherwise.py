"""A start of an identified base that shows only once effects are beside it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hystbench.blocks.starts import plainest_start, possible_starts
from hystbench.gap.fitting.edit_chain import without
from hystbench.gap.fitting.model_score import score_of
from hystbench.gap.fitting.refit import finished
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.records.floor import Floor
from hystbench.gap.simulation.simulation import Simulation
from hystbench.gap.simulation.starting import starting
from hystbench.model import Model
from hystbench.record import Record


def begun_as_named(
    base: Model, found: ModelState, records: tuple[Record, ...], floor: Floor
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
    floor : Floor

    Returns
    -------
    Model or None
        None where no record was given a path, no other effect shows a start, the base
        begins so already, or the other effects alone score worse beside that start.
    """
    if not found.paths or found.paths.issuperset(x.effect for x in found.added):
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
    if chain == base.chain:
        return None
    score = Score.plain(found.sample, floor.square)
    laws = without(found, found.paths)
    alone = replace(laws, chain=starting(laws.chain, best)).settled()
    if finished(alone, score)[1] > score_of(found, score):
        return None
    return replace(base, chain=chain)
