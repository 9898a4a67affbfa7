"""Records for a loop to be identified from, without what named effects do to them.

A base of plays is identified from a slow record, in which heat and creep show as well:
the loop takes a part of them, and what is left of the record then looks like a slow
path. Beside the law that does most the record is freed of what it does, and the loop
can be identified again.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hystbench.gap.bases.gpi import IdentifiedGpi
from hystbench.gap.effects import effects
from hystbench.gap.fitting.augmented_model import beside_blocks
from hystbench.gap.fitting.on_records import run_base
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.naming.rounds import Candidate
from hystbench.gap.naming.with_own_values import without
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.thresholds import ABOVE_NOISE, PAYS, SHAPE
from hystbench.model import Model
from hystbench.record import FloatArray, Record


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
    freed = replace(slow, y=slow.y - does).as_measured
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
