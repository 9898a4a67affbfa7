"""Whether the records know the size of an effect."""

from __future__ import annotations

from hystbench.gap.change import removable, without_effect
from hystbench.gap.fit import finished
from hystbench.gap.rank import make_score
from hystbench.gap.say import Say
from hystbench.gap.state import Added, State
from hystbench.gap.uncertainty import error_of_size, on_more_samples

UNKNOWN = 0.5
"""Standard error of an effect's size, as a share of it: two of them reach nothing."""


def without_unknown(state: State, floor_rms: float, say: Say) -> State:
    """Take out each further effect whose size the records do not know.

    Where its standard error is more than half of it, the records do not agree on the
    effect: it takes away what another one leaves in some of them. The first effect
    stays, as do those that are new in every record, and a hysteresis, which is judged
    as what others reshape.
    """
    if len(state.added) < 2:
        return state
    finer = on_more_samples(state)
    score = make_score(finer, floor_rms, forms=False)
    for number in reversed(range(1, len(state.added))):
        item = state.added[number]
        if not _is_judged(item, state) or not removable(state, number):
            continue
        error = error_of_size(finer, score, number)
        if error <= UNKNOWN:
            continue
        say(f"{item.effect} goes: the standard error of its size is {error:.0%} of it")
        short = without_effect(state, number)
        short, _ = finished(short, make_score(short, floor_rms))
        return without_unknown(short, floor_rms, say)
    return state


def _is_judged(item: Added, state: State) -> bool:
    blocks = [state.chain[k] for k in item.blocks]
    return bool(blocks) and not any(block.hysteretic for block in blocks)
