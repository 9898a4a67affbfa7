"""Effects that were added and go out again, and why."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from hystbench.gap.fitting.cross_validation import gain_on_folds
from hystbench.gap.fitting.edit_chain import removable, without_effect
from hystbench.gap.fitting.model_score import make_score, score_of
from hystbench.gap.fitting.refit import finished
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.fitting.uncertainty import on_more_samples, size_error
from hystbench.gap.progress import Say
from hystbench.gap.records.floor import Floor
from hystbench.gap.thresholds import CERTAIN, FURTHER, LOOSE, PAYS, SHAPE, UNKNOWN


class TakenOut(NamedTuple):
    """An effect that went out again."""

    name: str
    reason: str


Without = tuple[TakenOut, ModelState]
"""What went, and the model without it."""


def without_what_goes(
    state: ModelState, floor: Floor, gap: float | None, say: Say
) -> tuple[ModelState, tuple[TakenOut, ...]]:
    """Take out what is needless, then what is not known, while two effects are there.

    Parameters
    ----------
    state : ModelState
    floor : Floor
    gap : float or None
        Mean square of the base's gap above the floor; without it nothing is needless.
    say : callable

    Returns
    -------
    state : ModelState
    gone : tuple of TakenOut
        In the order in which they went.
    """
    rules: list[Callable[[ModelState], Without | None]] = []
    if gap is not None:
        rules.append(partial(needless, floor=floor, gap=gap))
    rules.append(partial(unknown, floor=floor))
    gone: list[TakenOut] = []
    for rule in rules:
        while len(state.added) > 1 and (found := rule(state)) is not None:
            one, state = found
            say(f"{one.name} goes: {one.reason}")
            gone.append(one)
    return state, tuple(gone)


def needless(state: ModelState, floor: Floor, gap: float) -> Without | None:
    """Find an effect that gains too little beside those that were added later.

    The score ignores what other forms of the remaining effects could explain. It does
    not ignore other forms of this effect, as they could stand in for it. Both models
    are refitted under this score. A wrong shape of the hysteresis has a high charge. It
    stays where it takes much of the gap, by the rule by which it was added.
    """
    for number, item in enumerate(state.added):
        if not removable(state, number):
            continue
        short = without_effect(state, number)
        score = make_score(short, floor)
        short, value = finished(short, score)
        if value - score_of(state, score) >= FURTHER:
            continue  # a refit could only add to it
        full, least = finished(state, score)
        gain = value - least
        share = full.share(short, floor.square, gap)
        if gain < FURTHER and not is_shape_that_matters(item.effect, gain, share):
            reason = f"needless beside the others, its gain is {gain:.1f}"
            return TakenOut(item.effect, reason), short
    return None


def is_shape_that_matters(effect: str, gain: float, share: float) -> bool:
    """Tell whether a wrong shape pays and takes much of the gap, dear as it is."""
    return effect == SHAPE and gain >= PAYS and share > LOOSE


def unknown(state: ModelState, floor: Floor) -> Without | None:
    """Find a further effect whose size the records do not know.

    An effect whose size is uncertain by more than half of it is dropped, unless it
    predicts records that did not fit it. The first effect always stays. So do effects
    that are new in every record, and hysteresis, which is judged as a shape.
    """
    finer = on_more_samples(state)
    for number in reversed(range(1, len(state.added))):
        blocks = [state.chain[k] for k in state.added[number].blocks]
        if not blocks or any(block.hysteretic for block in blocks):
            continue
        if not removable(state, number):
            continue
        error = size_error(finer, floor.square, number)
        if error <= UNKNOWN:
            continue
        short = without_effect(state, number)
        score = make_score(short, floor)
        short, _ = finished(short, score)
        if gain_on_folds(short, finished(state, score)[0], score) > CERTAIN:
            continue
        reason = f"the standard error of its size is {error:.0%} of it"
        if np.isnan(error):
            reason = "the records show nothing of it"
        return TakenOut(state.added[number].effect, reason), short
    return None
