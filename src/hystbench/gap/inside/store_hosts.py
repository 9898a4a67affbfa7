"""Stores that stand in place of a base."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from hystbench.blocks.gain import Gain
from hystbench.blocks.store import Store
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.host import Host, best_host, likeliest
from hystbench.gap.inside.same_as import as_simulated, missed, most_missed
from hystbench.gap.inside.stores import in_other_order, stores
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.thresholds import FURTHER

STORES = {1: "a store stands", 2: "two stores in series stand"}
"""How many are tried, and how that is told."""


def store_hosts(start: ModelState, identified: bool, score: Score) -> Iterator[Host]:
    """Give one store and two in series, fitted to the records.

    Beside a given base that is no store already those that simulate the same, and, in
    place of a linear base of few real poles, those that do not: it may fall below the
    bottom of a tank. A bent outflow has another rate than a linear one, so their
    numbers are fitted, and that counts as a further effect.
    """
    if not (identified or may_be_stores(start)):
        return
    noise = float(np.sqrt(score.floor))
    for count, words in STORES.items():
        begun = stores(start.records, start.hold, noise, count)
        best = best_host(begun, score)
        if best is None or not all_are_seen_filling(best.state):
            continue
        words, alone, charge = f"{words} in place of the base", best.state, 0.0
        if not identified:
            same, charge = stores_like(start, count), FURTHER
            words += ", fitted to the records"
            if same is None:
                words += ", as none simulates the same"
            else:
                alone = same
        yield Host(alone, best, words, charge=charge)
        for other in in_other_order(best.state):
            yield Host(alone, best, words, other, charge)


def may_be_stores(start: ModelState) -> bool:
    """Tell whether a base is linear, with no more poles than two stores, all real."""
    poles = [
        np.roots(block.denominator)
        for block in start.chain
        if isinstance(block, TransferFunction)
    ]
    linear = all(isinstance(block, TransferFunction | Gain) for block in start.chain)
    few = len(poles) == 1 and 1 <= len(poles[0]) <= len(STORES)
    return linear and few and bool(np.isreal(poles[0]).all())


def stores_like(start: ModelState, count: int) -> ModelState | None:
    """Give stores in series that simulate what a given base does, if any do."""
    simulated = as_simulated(start)
    sample = ScoredSamples.of(simulated)
    score = Score.plain(sample, np.finfo(float).tiny)
    best = likeliest(stores(simulated, start.hold, np.inf, count), score)
    if best is None or missed(best) > most_missed(start) * len(sample):
        return None
    return replace(best.state, records=start.records, sample=start.sample).settled()


def all_are_seen_filling(state: ModelState) -> bool:
    """Tell whether each of linear stores is slow enough for its records to show it.

    One that fills within a sampling interval does nothing; a law inside of it would be
    searched without end.
    """
    step = min(record.dt for record in state.records)
    rates = [block.rate for block in state.chain if isinstance(block, Store)]
    return max(rates) < np.pi / step
