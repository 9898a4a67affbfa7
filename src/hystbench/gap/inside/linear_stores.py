"""Stores in series as hosts: a tank, or one above another, whose outflow is linear."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from hystbench.blocks.gain import Gain
from hystbench.blocks.held import Hold
from hystbench.blocks.store import STARTS, Store
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.inside.host import Host
from hystbench.gap.inside.one_coordinate import (
    BEGUN,
    as_simulated,
    best_host,
    likeliest,
    missed,
    most_missed,
    span_and_step,
)
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.thresholds import FURTHER
from hystbench.record import Record

RATES = 6
"""Rates of outflow at which stores are begun, from slow to fast."""
FARTHEST = 5.0
"""Noise in times of its rms, at most: of a million samples one is farther off."""


def stores(
    records: tuple[Record, ...], hold: Hold, noise_rms: float, count: int
) -> Iterator[ModelState]:
    """Give stores in series, with all their numbers free, begun.

    At each set of rates the gain and a constant inflow are solved for. The level at the
    first sample is a number, or, of several records, that at which each rests. Nothing
    is given where the output is negative somewhere beyond what noise does: no level is.

    Parameters
    ----------
    records : tuple of Record
    hold : {"zero-order", "linear", "band-limited"}
    noise_rms : float
    count : {1, 2}
        How many.
    """
    if min(float(record.y.min()) for record in records) < -FARTHEST * noise_rms:
        return
    sample = ScoredSamples.of(records)
    wanted = sample.take([record.y for record in records])
    span, step = span_and_step(records)
    grid = np.geomspace(3 / span, 0.3 / step, RATES).tolist()
    found: list[tuple[float, tuple[Store, ...]]] = []
    for rates in itertools.combinations_with_replacement(grid, count):
        down = np.poly([-rate for rate in rates])
        unit = TransferFunction(
            numerator=(float(down[-1]),),
            denominator=tuple(down.tolist()),
            start="settled",
            hold=hold,
        )
        through = sample.take([unit.simulate(r.u, r.u, r.dt) for r in records])
        # What another level at the start leaves of it dies out with the stores' rates.
        begins = [
            sample.take([np.exp(-rate * r.time) for r in records]) for rate in rates
        ]
        columns = np.column_stack([through, np.ones(len(through)), *begins])
        amplitudes = np.linalg.lstsq(columns, wanted, rcond=None)[0]
        gain, offset = amplitudes[:2].tolist()
        if gain > 0:
            rest = float(np.mean((wanted - columns @ amplitudes) ** 2))
            inflow = float(records[0].u[0] + offset / gain)
            chain = _chain(rates, float(gain), float(offset / gain), inflow, hold)
            last = replace(chain[-1], start_level=max(float(records[0].y[0]), 0.0))
            found.append((rest, (*chain[:-1], last)))
    likely = [chain for _, chain in sorted(found, key=lambda item: item[0])[:BEGUN]]
    # One record's level is a number, wherever it rests.
    starts = STARTS if len(records) > 1 else STARTS[:1]
    for start, chain in itertools.product(starts, likely):
        free = [Free(0, "bias"), Free(len(chain) - 1, "gain")]
        for k in range(len(chain)):
            free.append(Free(k, "rate"))
            if start == "given":
                free.append(Free(k, "start_level"))
        begun = tuple(replace(store, start=start) for store in chain)
        if start != "given":
            begun = tuple(replace(store, start_level=0.0) for store in begun)
        yield ModelState(begun, records, sample, free=tuple(free), hold=hold)


def _chain(
    rates: tuple[float, ...], gain: float, bias: float, inflow: float, hold: Hold
) -> tuple[Store, ...]:
    """Write stores in series; all but the last have a gain of one."""
    start = max(inflow, 0.0)
    if len(rates) == 1:
        (rate,) = rates
        bias *= gain * rate
        store = Store(gain=gain * rate, rate=rate, exponent=1.0, bias=bias, hold=hold)
        return (store,)
    upper = Store(
        gain=1.0,
        rate=rates[0],
        exponent=1.0,
        bias=bias,
        start_level=start / rates[0],
        output="outflow",
        hold=hold,
    )
    # What flows out of a store is smooth, whatever flows into it.
    between: Hold = "linear" if hold == "zero-order" else hold
    size = gain * rates[1]
    return (upper, Store(gain=size, rate=rates[1], exponent=1.0, hold=between))


def in_other_order(state: ModelState) -> Iterator[ModelState]:
    """Give two stores in series with the slower and the faster one exchanged.

    While both are linear either order does the same but for how it starts. With a law
    inside one of them it does not, and no fit leads from one order to the other.
    """
    if len(state.chain) != 2:
        return
    upper, last = state.chain
    assert isinstance(upper, Store)  # noqa: S101  (for the type checker)
    assert isinstance(last, Store)  # noqa: S101  (for the type checker)
    ratio = upper.rate / last.rate
    level = upper.start_level * ratio  # as much flows out of it at first
    upper, last = (
        replace(upper, rate=last.rate, start_level=level),
        replace(last, rate=upper.rate, gain=last.gain * ratio),
    )
    yield replace(state, chain=(upper, last))


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
        yield Host(alone, best, words, charge=charge, kind="stores")
        for other in in_other_order(best.state):
            yield Host(alone, best, words, other, charge, "stores")


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
