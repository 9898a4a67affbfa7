"""What acts late in a model with forces inside: a lag, or a delay as long."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.drive_lag import DriveLag
from hystbench.blocks.input_delay import InputDelay
from hystbench.gap.effects.law import Law
from hystbench.gap.fitting.edit_chain import without_effect
from hystbench.gap.fitting.least_squares import Fitted, fitted_to_the_end
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.choose import best_of_each
from hystbench.gap.inside.insert_law import Offer, of_stores, with_law


def with_others_as_late(
    best: Fitted, found: Sequence[Fitted], offer: Offer, score: Score
) -> list[Fitted]:
    """Put in the place of a lag or a delay each other one that is as late.

    To first order in frequency all of them are the same: which of them was fitted to
    the end beside a force was hardly more than chance. Each begins as late as the one
    in its place, beside the forces as they were fitted.

    Parameters
    ----------
    best : Fitted
        With effects inside.
    found : sequence of Fitted
        All that were tried; the host alone first.
    offer : callable
        Gives what may be put in.
    score : Score

    Returns
    -------
    list of Fitted
        Those found and those put in; of each set of effects the best.
    """
    every, tried = list(found), {frozenset(item.effects) for item in found}
    if len(best.effects) < 2 or of_stores(best):
        return every
    for number, added in enumerate(best.state.added):
        late = sum(lateness(best.state.chain[place]) for place in added.blocks)
        if late > 0.0:
            rest = Fitted(without_effect(best.state, number), np.inf)
            if frozenset(rest.effects) not in tried:
                every.append(fitted_to_the_end(rest.state, score))
            begun = _as_late(rest, late, offer, added.effect)
            every += [fitted_to_the_end(state, score) for state in begun]
    return best_of_each(every)


def lateness(block: Block) -> float:
    """Give by how much a block is late at low frequency, in seconds; zero if it is not.

    A lag by its time constant, one of second order by ``2 damping_ratio`` of them.
    """
    if isinstance(block, InputDelay):
        return block.shift_s
    if isinstance(block, DriveLag):
        return block.time_constant_s * (2 * block.damping_ratio or 1.0)
    return 0.0


def _as_late(
    rest: Fitted, late: float, offer: Offer, instead_of: str
) -> Iterator[ModelState]:
    """Put each other lag or delay into a model, as late as that."""
    for name, laws in offer(rest).items():
        for law in laws:
            if name in (instead_of, *rest.effects) or not isinstance(law, Law):
                continue
            now = lateness(law.block)
            if now > 0.0:
                yield with_law(rest.state, name, _longer(law, late / now))


def _longer(law: Law, times: float) -> Law:
    """Make a lag or a delay so many times as long."""
    name = "delay_s" if isinstance(law.block, InputDelay) else "time_constant_s"
    value: dict[str, Any] = {name: times * getattr(law.block, name)}
    return replace(law, block=replace(law.block, **value))
