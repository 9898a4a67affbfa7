"""A model of one coordinate that simulates what a given base does."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from hystbench.blocks.gain import Gain
from hystbench.blocks.held import Hold
from hystbench.gap.cache import records_digest
from hystbench.gap.fitting.least_squares import Fitted
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.host import likeliest, with_a_zero
from hystbench.gap.inside.one_coordinate import one_coordinate, solved
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.thresholds import AS_GOOD
from hystbench.quantities import Quantities
from hystbench.record import Record


def same_as(
    start: ModelState, quantities: Quantities, floor: float
) -> ModelState | None:
    """Give a model of one coordinate that simulates what a given base does.

    It may differ by no more of the gap than two models that do the same. A zero and an
    offset are its own only where noise of that power does not hide what they do. Of a
    base that a gain and an offset do as well there is none: nothing moves in it.
    """
    simulated, most = as_simulated(start), most_missed(start)
    u, wanted = (start.sample.take(x) for x in ([r.u for r in simulated], start.exact))
    static = np.column_stack([u, np.ones(len(u))])
    moves = wanted - static @ solved(static, wanted)
    if np.mean(moves**2) < most:
        return None
    unseen = min(AS_GOOD * floor, most)
    shown = [float(np.sum(moves[part] ** 2)) for part in start.sample.slices]
    one = _ByContent((simulated[int(np.argmax(shown))],))
    every, count = _ByContent(simulated), len(ScoredSamples.of(simulated))
    about = quantities, start.hold
    for with_zero, enough in ((False, unseen), (True, most)):
        # What the best model of one record misses there, one of all records does too.
        alone = _coordinate_like(one, *about, with_zero)
        if len(simulated) > 1 and missed(alone) > enough * count:
            continue
        best = _coordinate_like(every, *about, with_zero)
        if best is not None and missed(best) <= enough * count:
            same = _without_offset(best, unseen * count)
            return replace(same, records=start.records, sample=start.sample).settled()
    return None


def as_simulated(start: ModelState) -> tuple[Record, ...]:
    """Give records whose output is what the base simulates."""
    return tuple(
        replace(record, y=y, simulated=None, interpolated=None)
        for record, y in zip(start.records, start.exact, strict=True)
    )


def most_missed(start: ModelState) -> float:
    """Give the mean square by which two models differ that do the same."""
    return AS_GOOD * float(np.mean(start.residual**2))


def _without_offset(best: Fitted, allowed: float) -> ModelState:
    """Leave out the gain and the offset behind a model that does as well without."""
    state = best.state
    if not isinstance(state.chain[-1], Gain):
        return state
    last = len(state.chain) - 1
    plain = replace(
        state,
        chain=state.chain[:-1],
        free=tuple(free for free in state.free if free.block != last),
    ).settled()
    return plain if float(np.sum(plain.residual**2)) <= allowed else state


def missed(found: Fitted | None) -> float:
    """Sum the squares of what a model misses."""
    return np.inf if found is None else float(np.sum(found.state.residual**2))


class _ByContent:
    """Records as a key: any others of the same content will do."""

    def __init__(self, records: tuple[Record, ...]) -> None:
        self.records, self.digest = records, records_digest(records)

    def __hash__(self) -> int:
        return hash(self.digest)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _ByContent) and self.digest == other.digest


@lru_cache(maxsize=4)
def _coordinate_like(
    simulated: _ByContent, quantities: Quantities, hold: Hold, with_zero: bool
) -> Fitted | None:
    """Fit a model of one coordinate to what a base simulates.

    That does not depend on what was measured: a second look, on records without their
    offsets, asks for the same one. Nothing of a simulation is noise.
    """
    records = simulated.records
    score = Score.plain(ScoredSamples.of(records), np.finfo(float).tiny)
    if with_zero:
        plain = _coordinate_like(simulated, quantities, hold, False)
        return None if plain is None else with_a_zero(plain, score)
    return likeliest(one_coordinate(records, quantities, hold), score)
