"""Whether anything is known of an effect's numbers."""

from __future__ import annotations

import numpy as np

from hystbench.gap.change import removable, without_effect
from hystbench.gap.fit import finished
from hystbench.gap.rank import make_score
from hystbench.gap.say import Say
from hystbench.gap.state import Added, State
from hystbench.gap.uncertainty import on_more_samples, standard_errors
from hystbench.record import FloatArray


def without_unknown(state: State, floor_rms: float, say: Say) -> State:
    """Take out each further effect of whose numbers none is known.

    Where every number is smaller than its standard error, the records do not agree on
    the effect: it takes away what another one leaves in some of them. The first effect
    stays, as do those that have numbers of their own in every record, and a
    hysteresis, whose many numbers stand in for each other.
    """
    if len(state.added) < 2:
        return state
    finer = on_more_samples(state)
    errors = standard_errors(finer, make_score(finer, floor_rms, forms=False))
    for number in reversed(range(1, len(state.added))):
        item = state.added[number]
        if _is_known(item, finer, errors) or not removable(state, number):
            continue
        say(f"{item.effect} goes: each of its numbers is smaller than its error")
        short = without_effect(state, number)
        short, _ = finished(short, make_score(short, floor_rms, forms=False))
        return without_unknown(short, floor_rms, say)
    return state


def _is_known(item: Added, state: State, errors: FloatArray) -> bool:
    if not item.blocks or any(state.chain[k].hysteretic for k in item.blocks):
        return True
    own = [k for k, free in enumerate(state.free) if free.block in item.blocks]
    values = np.array([abs(state.value(state.free[k])) for k in own])
    return bool(np.any(values > errors[own]))  # of NaN nothing is known
