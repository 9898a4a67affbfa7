"""Effects that were added and go out again, and why."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from hystbench.gap.fitting.cross_validation import gain_held_back
from hystbench.gap.fitting.edit_chain import removable, without_effect
from hystbench.gap.fitting.model_score import make_score, score_of
from hystbench.gap.fitting.refit import finished
from hystbench.gap.fitting.state import Added, ModelState
from hystbench.gap.fitting.uncertainty import on_more_samples, size_error
from hystbench.gap.progress import Say
from hystbench.gap.thresholds import CERTAIN, FURTHER, LOOSE, PAYS, SHAPE, UNKNOWN


class TakenOut(NamedTuple):
    """An effect that went out again."""

    name: str
    reason: str


Without = tuple[TakenOut, ModelState]
"""What went, and the model without it."""


def without_what_goes(
    state: ModelState, floor_rms: float, gap: float, say: Say
) -> tuple[ModelState, tuple[TakenOut, ...]]:
    """Take out what is needless, then what is not known, while two effects are there.

    Parameters
    ----------
    state : ModelState
    floor_rms : float
    gap : float
        Mean square of the base's gap above the floor.
    say : callable

    Returns
    -------
    state : ModelState
    gone : tuple of TakenOut
        In the order in which they went.
    """
    state, needless_ones = _without(
        partial(needless, floor_rms=floor_rms, gap=gap), state, say
    )
    state, unknown_ones = without_unknown(state, floor_rms, say)
    return state, (*needless_ones, *unknown_ones)


def without_unknown(
    state: ModelState, floor_rms: float, say: Say
) -> tuple[ModelState, tuple[TakenOut, ...]]:
    """Take out what is not known alone; arguments as of :func:`without_what_goes`."""
    return _without(partial(unknown, floor_rms=floor_rms), state, say)


def _without(
    look: Callable[[ModelState], Without | None], state: ModelState, say: Say
) -> tuple[ModelState, tuple[TakenOut, ...]]:
    gone: tuple[TakenOut, ...] = ()
    while len(state.added) > 1 and (found := look(state)) is not None:
        one, state = found
        say(f"{one.name} goes: {one.reason}")
        gone = (*gone, one)
    return state, gone


def needless(state: ModelState, floor_rms: float, gap: float) -> Without | None:
    """Find an effect that gains too little beside those that were added later.

    An effect is judged by what can be reshaped without it: other forms of itself would
    stand in for it. Both models are refitted under that score. A wrong shape of the
    hysteresis, which is charged dearly, stays where it takes much of the gap away, by
    the rule by which it was added.
    """
    for number, item in enumerate(state.added):
        if not removable(state, number):
            continue
        short = without_effect(state, number)
        score = make_score(short, floor_rms)
        short, value = finished(short, score)
        if value - score_of(state, score) >= FURTHER:
            continue  # a refit could only add to it
        full, least = finished(state, score)
        gain = value - least
        share = full.share(short, floor_rms**2, gap)
        if gain < FURTHER and not is_shape_that_matters(item.effect, gain, share):
            reason = f"needless beside the others, its gain is {gain:.1f}"
            return TakenOut(item.effect, reason), short
    return None


def is_shape_that_matters(effect: str, gain: float, share: float) -> bool:
    """Tell whether a wrong shape pays and takes much of the gap, dear as it is."""
    return effect == SHAPE and gain >= PAYS and share > LOOSE


def unknown(state: ModelState, floor_rms: float) -> Without | None:
    """Find a further effect whose size the records do not know.

    Where its standard error is more than half of it, the records do not agree on the
    effect: it takes away what another one leaves in some of them. If few records show
    it but others foretell it beyond doubt, it stays. So do the first effect, those
    that are new in every record, and a hysteresis, which is judged as what others
    reshape.
    """
    finer = on_more_samples(state)
    for number in reversed(range(1, len(state.added))):
        item = state.added[number]
        if not _is_judged(item, state) or not removable(state, number):
            continue
        error = size_error(finer, floor_rms**2, number)
        if error <= UNKNOWN:
            continue
        short = without_effect(state, number)
        score = make_score(short, floor_rms)
        short, _ = finished(short, score)
        if gain_held_back(short, finished(state, score)[0], score) > CERTAIN:
            continue
        reason = f"the standard error of its size is {error:.0%} of it"
        if np.isnan(error):
            reason = "the records show nothing of it"
        return TakenOut(item.effect, reason), short
    return None


def _is_judged(item: Added, state: ModelState) -> bool:
    blocks = [state.chain[k] for k in item.blocks]
    return bool(blocks) and not any(block.hysteretic for block in blocks)
