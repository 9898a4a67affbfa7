"""Stores in series as hosts: a tank, or one above another, whose outflow is linear."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from hystbench.blocks.held import Hold
from hystbench.blocks.store import STARTS, Store
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.effects.law import Changed, Filled
from hystbench.gap.fitting.state import Added, Free, ModelState
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.record import Record

RATES = 6
"""Rates of outflow at which stores are begun, from slow to fast."""
FARTHEST = 5.0
"""Noise in times of its rms, at most: of a million samples one is farther off."""
BEGUN = 3
"""Starts that are fitted, the best ones of the grid."""


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
    span = max(record.dt * len(record) for record in records)
    fastest = 0.3 / min(record.dt for record in records)
    grid = np.geomspace(3 / span, fastest, RATES).tolist()
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
    for start, chain in itertools.product(_starts(records), likely):
        free = [Free(0, "bias"), Free(len(chain) - 1, "gain")]
        for k in range(len(chain)):
            free.append(Free(k, "rate"))
            if start == "given":
                free.append(Free(k, "start_level"))
        begun = tuple(replace(store, start=start) for store in chain)
        if start != "given":
            begun = tuple(replace(store, start_level=0.0) for store in begun)
        yield ModelState(begun, records, sample, free=tuple(free), hold=hold)


def _starts(records: Sequence[Record]) -> tuple[str, ...]:
    """Give the starts of stores: one record's level is a number, wherever it rests."""
    return STARTS if len(records) > 1 else STARTS[:1]


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
    yield state.with_chain((upper, last))


def how_it_fills(state: ModelState) -> Filled:
    """Look how high the stores of a chain are filled on its records."""
    tops = []
    for k, block in enumerate(state.chain):
        if isinstance(block, Store):
            level = replace(block, output="level")
            signals = state.simulation.tail(k, [level])
            tops.append((k, block, max(float(z.max()) for z in signals)))
    measured = max(float(record.y.max()) for record in state.records)
    last = state.chain[-1]
    is_shown = isinstance(last, Store) and last.output == "level" and measured > 0
    known = all(free.given is not None for free in state.free)
    return Filled(tuple(tops), measured if is_shown else None, known)


def with_changed(state: ModelState, effect: str, changed: Changed) -> ModelState:
    """Give stores with other numbers, some of them free as well.

    What was known of such a number says nothing of it any more.
    """
    chain = list(state.chain)
    old = {
        f"{place}.{name}": float(getattr(chain[place], name))
        for place, values in changed.values.items()
        for name in values
    }
    for place, values in changed.values.items():
        chain[place] = replace(chain[place], **values)
    places = tuple(changed.values)
    was_free = tuple(x for x in state.free if f"{x.block}.{x.parameter}" in old)
    free = tuple(
        Free(x.block, x.parameter) if x in was_free and x.given is not None else x
        for x in state.free
    )
    more = tuple(x for x in (Free(*own) for own in changed.free) if x not in free)
    charge = max(float(len(more)), 1.0)
    item = Added(effect, "inside", changed.form, places, old, charge, was_free=was_free)
    return replace(
        state, chain=tuple(chain), free=(*free, *more), added=(*state.added, item)
    )
