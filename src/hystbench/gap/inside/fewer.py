"""A search on fewer samples of long records, and its result on all of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.starts import plainest_start, possible_starts
from hystbench.gap.fitting.least_squares import Fitted, fitted, judged
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.choose import way_to
from hystbench.gap.inside.race import FEW
from hystbench.gap.inside.try_hosts import Tried
from hystbench.gap.records.coarser import coarser, left_out
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.simulation.simulation import Simulation
from hystbench.gap.simulation.starting import starting
from hystbench.gap.thresholds import PAYS
from hystbench.quantities import Quantities
from hystbench.record import FloatArray


def on_fewer(start: ModelState, quantities: Quantities) -> ModelState:
    """Give a model on fewer samples of its records, or as it is where none are spared.

    Of whole periods the last ones are left, and the model starts on them as if they had
    come before. Only where a force makes a motion: the other way round its rates count,
    and a store does not forget how it was filled.

    Parameters
    ----------
    start : ModelState
    quantities : Quantities
        What the device takes and gives.
    """
    if quantities.causality != "force to motion":
        return start
    if any(record.decay_s is not None for record in start.records):
        return start
    records = coarser(start.records, start.hold)
    if records is start.records:
        return start
    chain = start.chain
    if left_out(records, start.records):
        chain = starting(chain, "repeating")
    return replace(
        start, chain=chain, records=records, sample=ScoredSamples.of(records)
    ).settled()


@dataclass(frozen=True)
class OnAll:
    """Models that were found on fewer samples, on all of them."""

    whole: ModelState
    """The base, with the records."""
    score: Score
    """Score on all records."""
    start: str
    """How linear dynamics start on them."""

    @classmethod
    def of(
        cls, whole: ModelState, score: Score, host: ModelState, identified: bool
    ) -> OnAll:
        """Choose the plainest start with which a host does nearly as well as with any.

        Parameters
        ----------
        whole : ModelState
        score : Score
        host : ModelState
            Linear, on fewer samples.
        identified : bool
            Whether it is to follow the records; else it is to do what the base does.
        """
        outputs = whole.simulation.output
        wanted = whole.reference if identified else whole.sample.take(outputs)
        starts = possible_starts(whole.records)
        costs = [
            float(np.sum((wanted - _simulated(whole, starting(host.chain, own))) ** 2))
            for own in starts
        ]
        return cls(whole, score, starts[plainest_start(costs)])

    def state(self, found: ModelState) -> ModelState:
        """Give a model with all samples, as it was fitted to fewer."""
        return replace(
            found,
            chain=starting(found.chain, self.start),
            records=self.whole.records,
            sample=self.whole.sample,
        ).settled()

    def hypotheses(
        self, found: Sequence[Fitted], best: Sequence[Fitted]
    ) -> list[Fitted]:
        """Fit the best ones and their rivals to all samples, and score the others.

        A rival is as good as a best one of as many effects, but for what would pay for
        an effect.
        """

        def rivals(item: Fitted) -> bool:
            return any(
                len(item.effects) == len(one.effects) and item.score < one.score + PAYS
                for one in best
            )

        on_all = []
        for item in found:
            state = self.state(item.state)
            on_all.append(
                fitted(state, self.score, FEW)
                if rivals(item)
                else Fitted(state, judged(state, self.score))
            )
        return on_all


def on_all_samples(
    tried: Tried, start: ModelState, score: Score, identified: bool
) -> Tried:
    """Give what was tried in a host on fewer samples on all of them, the best the same.

    The base and the score are on all samples. An identified host is fitted anew.
    """
    host, best = tried.host, tried.best
    on_all = OnAll.of(start, score, host.alone, identified)
    way = (tried.found[0], *way_to(best, tried.found))
    found = on_all.hypotheses(tried.found, way)
    place = [item is best for item in tried.found].index(True)
    alone = found[0].state if identified else on_all.state(host.alone)
    return Tried(replace(host, alone=alone), found, found[place])


def _simulated(whole: ModelState, chain: tuple[Block, ...]) -> FloatArray:
    simulation = Simulation(chain, whole.records, whole.hold, "quick")
    return whole.sample.take(simulation.output)
