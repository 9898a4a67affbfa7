"""The beginnings of records, on which many laws are compared roughly.

A simulation runs over whole records, and a fit simulates them some hundred times. Which
of many laws is likely is seen on less: a quarter of each record, and as much as holds a
quarter of what the host leaves of it. Records that move alike from end to end become
four times as short; one that is driven harder and harder keeps most of its length. A
record that repeats stays whole: of several, the two are left of which the host leaves
least and most, as a rule the most gently driven and the hardest driven.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import ceil

import numpy as np
from numpy.typing import NDArray

from hystbench.blocks.other_modes import OtherModes
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.record import Record

PART = 0.25
"""Share of a record's residual power, and of its samples, that its beginning holds."""


@dataclass(frozen=True)
class Beginnings:
    """Records that were cut, and what is scored of them."""

    records: tuple[Record, ...]
    sample: ScoredSamples
    kept: NDArray[np.bool_]
    """Shape (scored samples,). Which of the whole records' scored samples are left."""
    score: Score
    cut_short: bool = False
    """Whether records end before all that is in them was seen; whole periods do not."""

    @classmethod
    def of(cls, state: ModelState, score: Score) -> Beginnings:
        """Cut the records where a quarter of a model's residual power has passed.

        Of those that repeat leave out all but two.

        Parameters
        ----------
        state : ModelState
        score : Score
            Of the whole records.
        """
        records, positions, of_start, kept = [], [], [], []
        # A period that came before is of use only as a whole.
        repeats = any(
            getattr(block, "start", "") == "repeating" for block in state.chain
        )
        rest = np.nan_to_num(state.residual)
        powers = [float(np.mean(rest[part] ** 2)) for part in state.sample.slices]
        ends = {int(np.argmin(powers)), int(np.argmax(powers))}
        own_starts = state.sample.of_start or (None,) * len(state.records)
        for number, (record, places, part, start) in enumerate(
            zip(
                state.records,
                state.sample.positions,
                state.sample.slices,
                own_starts,
                strict=True,
            )
        ):
            if repeats and number not in ends:
                kept.append(np.zeros(len(places), dtype=bool))
                continue
            passed = np.cumsum(rest[part] ** 2)
            count = int(np.searchsorted(passed, PART * passed[-1])) + 1
            count = max(count, ceil(PART * len(places)))
            if repeats:
                count = len(places)
            end = len(record) if count == len(places) else int(places[count - 1]) + 1
            records.append(record.cut(slice(end)))
            positions.append(places[:count])
            if start is not None:
                of_start.append(start[:count])
            kept.append(np.arange(len(places)) < count)
        sample, mask = (
            ScoredSamples(tuple(positions), tuple(of_start)),
            np.concatenate(kept),
        )
        own = Score(sample, score.directions[mask], score.floor)
        return cls(tuple(records), sample, mask, own, cut_short=not repeats)

    @classmethod
    def all_of(cls, state: ModelState, score: Score) -> Beginnings:
        """Leave the records whole: stores fill and run empty once."""
        kept = np.ones(len(state.sample), dtype=bool)
        return cls(state.records, state.sample, kept, score)

    def cut(self, state: ModelState) -> ModelState:
        """Give a model on the beginnings; of it the host and its forces are free.

        What other modes do beside them is nearly right, and is fitted in the end.
        """
        free = (
            x for x in state.free if not isinstance(state.chain[x.block], OtherModes)
        )
        less = state.on(self.records, self.sample, self.kept)
        return replace(less, free=tuple(free))
