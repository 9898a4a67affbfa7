"""Records for a loop to be identified from, without what named effects do to them.

A base of plays is identified from a slow record, in which heat and creep show as well:
the loop takes a part of them, and what is left of the record then looks like a slow
path. Beside the law that does most the record is freed of what it does, and the loop
can be identified again. So much creep may be in the record that no law pays beside the
loop: then the record itself tells how much.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hystbench.blocks.logarithmic_creep import LogarithmicCreep
from hystbench.gap.bases.gpi import ORDER, IdentifiedGpi
from hystbench.gap.effects import effects
from hystbench.gap.effects.slow import QUICKEST, SLOW_SAMPLES
from hystbench.gap.fitting.augmented_model import beside_blocks
from hystbench.gap.fitting.on_records import run_base
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.naming.rounds import Candidate
from hystbench.gap.naming.with_own_values import without
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.thresholds import ABOVE_NOISE, LOOSE, PAYS, SHAPE
from hystbench.model import Model
from hystbench.record import FloatArray, Record

MOST_CREEP = 0.9
"""Magnitude at most: creep beyond that is more than the motion that creeps."""
CLOSE = 0.05
"""How near the magnitude is found: what is named beside the loop finds it better."""
ROUNDS = 50
"""In how many rounds creep is taken off: each leaves its magnitude of what is wrong."""


def freed_of_laws(
    base: Model, named: Named, evidence: Evidence, floor_rms: float
) -> Evidence | None:
    """Take what laws do off the record that a loop was identified from.

    Parameters
    ----------
    base : Model
    named : Named
        What was named beside it, or beside the same with other numbers. Paths and a
        wrong shape are no laws; where there is nothing else, the first law that paid in
        a round is taken.
    evidence : Evidence
        With the fit records.
    floor_rms : float

    Returns
    -------
    Evidence or None
        None where the base is no loop that was identified, no law pays, or laws do to
        the record no more than half of what noise does, in power.
    """
    laws = _laws(named) if isinstance(base, IdentifiedGpi) else None
    if laws is None:
        return None
    slow = evidence.slowest
    bare = without(laws, {item.effect for item in laws.added})
    with_them, alone = (_simulated(base, own, slow) for own in (laws, bare))
    does = with_them - alone
    if np.var(does) <= ABOVE_NOISE * floor_rms**2:
        return None
    return _with(evidence, replace(slow, y=slow.y - does).as_measured)


def freed_of_creep(
    base: Model, evidence: Evidence, floor_rms: float
) -> Evidence | None:
    """Take creep off the record that a loop was identified from, if a loop then fits.

    The time constants are all that creep is looked for with, and its magnitude is the
    one with which the loop leaves least of its record.

    Parameters
    ----------
    base : Model
    evidence : Evidence
        With the fit records.
    floor_rms : float

    Returns
    -------
    Evidence or None
        None where the base is no loop that was identified, or leaves no more of its
        record than noise; where the loop leaves most of that without creep as well; or
        where creep does no more than noise does.
    """
    slow = evidence.slowest
    span = slow.dt * len(slow)
    if not isinstance(base, IdentifiedGpi) or len(slow) < SLOW_SAMPLES:
        return None
    left = float(np.var(slow.y - run_base(base, (slow,), evidence.input_hold)[0]))
    noise = floor_rms**2
    if left <= (1 + ABOVE_NOISE) * noise:
        return None
    # Late: few loops creep so much.
    from scipy.optimize import minimize_scalar

    from hystbench.identification import identify

    def without_creep(magnitude: float) -> Record:
        creep = LogarithmicCreep(
            magnitude=magnitude, first_time_s=span / QUICKEST, last_time_s=span
        )
        y = slow.y
        for _ in range(ROUNDS):
            y = slow.y - (creep.simulate(y, slow.u, slow.dt) - y)
        return replace(slow, y=y).as_measured

    def stays(magnitude: float) -> float:
        freed = without_creep(magnitude)
        return float(
            np.var(freed.y - identify(freed.u, freed.y, ORDER).simulate(freed.u))
        )

    best = minimize_scalar(stays, bounds=(0, MOST_CREEP), options={"xatol": CLOSE})
    freed = without_creep(best.x)
    if (
        best.fun > LOOSE * left
        or np.var(slow.y - freed.y) <= ABOVE_NOISE * floor_rms**2
    ):
        return None
    return _with(evidence, freed)


def _with(evidence: Evidence, freed: Record) -> Evidence:
    """Put a record in the place of the one that a loop is identified from."""
    slow = evidence.slowest
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
    laws = _without_paths(named.state)
    if laws.added:
        return laws
    tried = (item for one in named.rounds for item in one.ranking)
    states = (x.state for x in tried if _is_law(x))
    return next((_without_paths(x) for x in states if x is not None), None)


def _without_paths(state: ModelState) -> ModelState:
    return without(state, {*state.paths, SHAPE})


def _is_law(item: Candidate) -> bool:
    """Tell whether an effect pays, by a law of few numbers."""
    pays = item.state is not None and item.gain >= PAYS
    return pays and item.form not in effects()[item.effect].free_forms
