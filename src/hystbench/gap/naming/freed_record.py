"""Records for a loop to be identified from, without what named effects do to them.

A base of plays is identified from a slow record, in which heat and creep show as well:
the loop takes a part of them, and what is left of the record then looks like a slow
path. Beside the law that does most the record is freed of what it does, and the loop
can be identified again. So much of them may be in the record that no law pays beside
the loop: then the record itself tells how much.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.logarithmic_creep import LogarithmicCreep
from hystbench.blocks.thermal_drift import ThermalDrift
from hystbench.gap.bases.gpi import ORDER, IdentifiedGpi
from hystbench.gap.effects import effects
from hystbench.gap.effects.slow import SLOW_SAMPLES
from hystbench.gap.fitting.augmented_model import beside_blocks
from hystbench.gap.fitting.edit_chain import without
from hystbench.gap.fitting.on_records import run_base
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.naming.rounds import Candidate
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.floor import Floor
from hystbench.gap.thresholds import ABOVE_NOISE, LOOSE, PAYS
from hystbench.model import Model
from hystbench.record import FloatArray, Record

MOST_CREEP = 0.9
"""Magnitude at most: creep beyond that is more than the motion that creeps."""
CREEPS = (1.0, 4.0, 16.0)
"""The record holds so many of the longest time constants of creep. A factor of four
between them is little beside the spread of each."""
SPREAD = 50.0
"""The longest time constant of a creep over its shortest."""
HEATS = (60.0, 20.0, 7.0)
"""The record holds so many of the time constants of heat: of any between, one is off by
a factor of 1.8 at most."""
CLOSE = 0.01
"""How near a size is found: what is named beside the loop finds it better."""
ROUNDS = 50
"""In how many rounds creep is taken off, at most: each leaves its magnitude of what is
wrong. Heat is off after the first."""
ROUNDING = 1e-12
"""Share of the output's range by which a round changes nothing."""


def freed_of_laws(
    base: Model, named: Named, evidence: Evidence, floor: Floor
) -> Evidence | None:
    """Take what laws do off the record that a loop was identified from.

    Parameters
    ----------
    base : Model
    named : Named
        What was named beside it, or beside the same with other numbers. Paths are no
        laws, and curves and loops are the loop's own; where there is nothing else, the
        first law that paid in a round is taken.
    evidence : Evidence
        With the fit records.
    floor : Floor

    Returns
    -------
    Evidence or None
        None where the base is no loop that was identified, no law pays, or laws do to
        the record no more than half of what noise does, in power.
    """
    laws = _laws(named) if isinstance(base, IdentifiedGpi) else None
    if laws is None:
        return None
    slow = evidence.to_identify_from
    bare = without(laws, {item.effect for item in laws.added})
    with_them, alone = (_simulated(base, own, slow) for own in (laws, bare))
    does = with_them - alone
    if _power(does, slow) <= ABOVE_NOISE * floor.square:
        return None
    return _with_record(evidence, replace(slow, y=slow.y - does).as_measured)


def freed_of_slow_law(
    base: Model, evidence: Evidence, floor: Floor, offered: Collection[str]
) -> Evidence | None:
    """Take creep or heat off the record that a loop was identified from.

    A law is tried by its size: by the one with which the loop and the law leave least
    of all fit records. Of creep and of heat some ranges of time constants are tried.

    Parameters
    ----------
    base : Model
    evidence : Evidence
        With the fit records.
    floor : Floor
    offered : collection of str
        Effects that the device may have.

    Returns
    -------
    Evidence or None
        With the law that leaves least. None where the base is no loop that was
        identified, or leaves no more than noise; where it leaves most of that beside
        each law as well; or where the best does to the record no more than half of what
        noise does, in power.
    """
    slow = evidence.to_identify_from
    if not isinstance(base, IdentifiedGpi) or len(slow) < SLOW_SAMPLES:
        return None
    outputs = run_base(base, evidence.fit, evidence.input_hold)
    left = _left(evidence.fit, outputs)
    noise = floor.square
    if left <= (1 + ABOVE_NOISE) * noise:
        return None
    # Late: few loops creep so much.
    from scipy.optimize import minimize_scalar

    from hystbench.identification import identify

    every = max(len(slow) // SLOW_SAMPLES, 1)

    def left_with(size: float, make: Callable[[float], Any]) -> float:
        law = make(size)
        y = _freed_of(law, slow)
        loop = identify(slow.u[::every], y[::every], ORDER, starts=1)
        outputs = [law.simulate(loop.simulate(x.u), x.u, x.dt) for x in evidence.fit]
        return _left(evidence.fit, outputs)

    least, freed = LOOSE * left, slow
    for law, bounds in _slow_laws(slow, offered):
        best = minimize_scalar(
            left_with, args=(law,), bounds=bounds, options={"xatol": CLOSE}
        )
        if best.fun < least:
            least, freed = best.fun, replace(slow, y=_freed_of(law(best.x), slow))
    if _power(slow.y - freed.y, slow) <= ABOVE_NOISE * noise:
        return None
    return _with_record(evidence, freed.as_measured)


def _left(records: Sequence[Record], outputs: Sequence[FloatArray]) -> float:
    """Give the power that is left of records, without what each has as its zero."""
    pairs = zip(records, outputs, strict=True)
    return float(np.mean([_power(record.y - y, record) for record, y in pairs]))


def _power(signal: FloatArray, record: Record) -> float:
    """Give the power of a signal about its mean, of a record's samples that count."""
    return float(np.var(signal[record.counted]))


def _slow_laws(
    record: Record, offered: Collection[str]
) -> Iterator[tuple[Callable[[float], Block], tuple[float, float]]]:
    """Give laws by their size, with its bounds: creep and heat by some time scales."""
    span = record.dt * len(record)
    if "creep" in offered:
        for part in CREEPS:
            yield partial(_creep, span / part), (0.0, MOST_CREEP)
    if "thermal-drift" in offered:
        # Of the output's range, where the input's square stays at its largest.
        one = float(np.ptp(record.y) / np.max(record.u**2))
        for part in HEATS:
            heats = partial(_heat, span / part, one)
            yield heats, (-1.0, 1.0)


def _creep(longest_s: float, size: float) -> Block:
    return LogarithmicCreep(
        magnitude=size, first_time_s=longest_s / SPREAD, last_time_s=longest_s
    )


def _heat(time_constant_s: float, one: float, size: float) -> Block:
    return ThermalDrift(coefficient=size * one, time_constant_s=time_constant_s)


def _freed_of(law: Any, record: Record) -> FloatArray:
    """Take what a law does off a record's output."""
    y, exact = record.y, ROUNDING * float(np.ptp(record.y))
    for _ in range(ROUNDS):
        before, y = y, record.y - (law.simulate(y, record.u, record.dt) - y)
        if np.max(np.abs(y - before)) <= exact:
            break
    return y


def _with_record(evidence: Evidence, freed: Record) -> Evidence:
    """Put a record in the place of the one that a loop is identified from."""
    slow = evidence.to_identify_from
    fit = tuple(freed if record is slow else record for record in evidence.fit)
    return replace(evidence, fit=fit)


def _simulated(base: Model, state: ModelState, record: Record) -> FloatArray:
    """Simulate a state's chain, with what stands beside it, on a whole record."""
    chain = (*state.chain, *beside_blocks(state))
    model = Model(base.name, base.input, base.output, chain)
    return run_base(model, (record,), state.hold)[0]


def _laws(named: Named) -> ModelState | None:
    """Give the base with the laws that were named, or with the one that does best.

    A path that was named first may have taken what a law does: beside it the law pays.
    """
    laws = _of_time(named.state)
    if laws.added:
        return laws
    tried = (item for one in named.rounds for item in one.ranking)
    states = (x.state for x in tried if _is_law(x))
    return next((_of_time(x) for x in states if x is not None), None)


def _of_time(state: ModelState) -> ModelState:
    """Leave out paths, and what a loop with envelopes does itself: it stays in it."""
    own = {
        item.effect
        for item in state.added
        if effects()[item.effect].shows in ("amplitude", "branch")
    }
    return without(state, {*state.paths, *own})


def _is_law(item: Candidate) -> bool:
    """Tell whether an effect pays, by a law of few numbers."""
    pays = item.state is not None and item.gain >= PAYS
    return pays and item.form not in effects()[item.effect].free_forms
