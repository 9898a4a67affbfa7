"""Naming beside what records have of their own: a late trigger, another range."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from hystbench.gap.fit import score_of
from hystbench.gap.name import Named, name
from hystbench.gap.own_values import KINDS, NONE, OwnValues, own_values
from hystbench.gap.rank import make_score
from hystbench.gap.say import Say
from hystbench.gap.scene import Scene
from hystbench.gap.state import State
from hystbench.gap.thresholds import PAYS
from hystbench.record import FloatArray


def named_apart(
    start: State, floor_rms: float, named: Named, say: Say
) -> tuple[State, Named, OwnValues]:
    """Name anew beside what records have of their own, where that explains them better.

    Effects go first: they are laws, with few numbers, that hold for every record. What
    records have of their own is looked for beside the base and beside the effects that
    were named. Where it lowers the score by as much as a first effect has to, all its
    numbers charged, it is taken off the records and naming begins again; and the better
    of both explanations stays, by the same score.

    Parameters
    ----------
    start : State
        The base on the fit records.
    floor_rms : float
    named : Named
        What was named on the records as they are.
    say : callable
        Told a line of progress at a time.

    Returns
    -------
    start : State
        The base, on records without what is their own.
    named : Named
    own : OwnValues
    """
    score = make_score(start, floor_rms, forms=False)
    least = score_of(named.state, score) - PAYS
    kinds = kinds_of(start)
    tried: list[tuple[float, OwnValues]] = []
    for state in (start, named.state):
        own = own_values(start.records, simulated(state), floor_rms**2, kinds)
        if own.records:
            value = score_of(on_records_without(state, own), score) + own.charge
            tried.append((value, own))
    value, own = min(tried, key=lambda item: item[0], default=(least, NONE))
    if value >= least:
        return start, named, NONE
    say(f"records have {' and '.join(own.kinds)} of their own: naming beside that")
    apart = on_records_without(start, own)
    again = name(apart, floor_rms, say)
    if score_of(again.state, score) + own.charge >= least:
        return start, named, NONE
    square = floor_rms**2
    share = apart.share(start, square, start.power(square))
    return apart, again, replace(own, share=share)


def kinds_of(state: State) -> tuple[str, ...]:
    """Give what may be a record's own: no delay where the base cannot be run again."""
    reruns = all(block.reruns for block in state.chain)
    return KINDS if reruns else tuple(kind for kind in KINDS if kind != "delay")


def on_records_without(state: State, own: OwnValues) -> State:
    """Give a model on records from which what is their own is taken off."""
    records = own.taken_off(state.records, state.hold)
    return replace(state, records=records, correction=None).settled()


def simulated(state: State) -> Sequence[FloatArray]:
    """Give the output of a model's chain on the fit records."""
    return Scene(state.chain, state.records, state.hold, fine=True).output
