"""A force that acts in one mode of a structure, in other modes of it as well."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, replace

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.force import Force
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.other_mechanism import OtherMechanism
from hystbench.blocks.other_modes import OtherModes
from hystbench.gap.fitting.least_squares import Fitted, fitted
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Added, Free, ModelState
from hystbench.gap.inside.beginnings import Beginnings
from hystbench.gap.inside.combine_forces import fitted_likely, may_gain, starts
from hystbench.gap.inside.insert_law import Offer, host_of
from hystbench.gap.inside.modes import (
    NONE,
    NUMBERS,
    explained_by_levels,
    frequency_of,
    numbers_of,
    taken_out,
)
from hystbench.gap.progress import Say, silent
from hystbench.gap.thresholds import CERTAIN, FURTHER, UNNAMED_SHARE


def for_a_further(taken: float, share: float) -> float:
    """Give what a further effect must lower the score by.

    One that takes less of the gap than may stay unnamed has to be beyond doubt.
    """
    return FURTHER if taken > share else CERTAIN


def in_further_modes(
    found: Fitted,
    offer: Offer,
    score: Score,
    say: Say = silent,
    share: float = UNNAMED_SHARE,
) -> tuple[Fitted, tuple[float, ...]]:
    """Let a force act in other modes too, one after the other, while that pays.

    A joint that slips is in every mode that moves it. It is one effect, with numbers of
    its own in each mode, and it has to pay in each as a further effect does. The mode
    itself may be fitted without the force, so that the force has no credit of that.

    Parameters
    ----------
    found : Fitted
    offer : callable
        Gives what may be put into the last host of a model.
    score : Score
    say : callable
    share : float
        Of the power of the gap: what takes less in a mode does not matter.

    Returns
    -------
    found : Fitted
    frequencies : tuple of float
        Natural frequencies, in Hz, of the modes that were taken, as they were before.
    """
    modes: list[float] = []
    while may_gain(found, score) and (more := _in_one_more(found, offer, score, share)):
        found, frequency = more
        modes.append(frequency)
        host = found.state.chain[host_of(found.state)]
        say(f"inside: also in the mode at {frequency_of(host):.3g} Hz")
    return found, tuple(modes)


def with_modes(state: ModelState, frequencies: tuple[float, ...]) -> ModelState:
    """Write the modes nearest to frequencies as mechanisms; it does what it did."""
    for wanted in frequencies:
        split = list(with_another_mode(state))
        if not split:
            break  # its other poles are real
        state = min(split, key=lambda one: abs(np.log(_frequency(one) / wanted)))
    return state


def _frequency(state: ModelState) -> float:
    """Give the natural frequency of the mode that was taken out last, in Hz."""
    return frequency_of(state.chain[state.free[-1].block])


def further_words(state: ModelState) -> str:
    """Tell which further modes are mechanisms; nothing if none is."""
    modes = [x for x in state.chain if isinstance(x, OtherMechanism)]
    return "".join(f", as is that at {frequency_of(mode):.3g} Hz" for mode in modes)


def _in_one_more(
    found: Fitted, offer: Offer, score: Score, share: float
) -> tuple[Fitted, float] | None:
    """Put the force into the mode that needs it most; None if it does not pay there."""
    state = found.state
    acting = [
        item
        for item in state.added
        if item.blocks and isinstance(state.chain[item.blocks[0]], Force)
    ]
    split = list(with_another_mode(state))
    if not split or not acting:
        return None
    # The mode of which other numbers would explain most of the records.
    chosen = max(
        split,
        key=lambda one: explained_by_levels(
            replace(one, free=one.free[-len(NUMBERS) :])
        ),
    )
    linear = fitted(chosen, score)
    laws = offer(linear)
    beginnings = Beginnings.of(linear.state, score)
    short = beginnings.cut(linear.state)
    begun = [
        start
        for item in acting
        for start in starts(
            linear,
            short,
            item.effect,
            [law for law in laws.get(item.effect, ()) if law.form == item.form],
            beginnings,
        )
    ]
    best = fitted_likely(begun, beginnings, score, 1)
    if not best:
        return None
    also = best[0]
    gap = max(state.power(score.floor), score.floor)
    taken = also.state.share(linear.state, score.floor, gap)
    pays = for_a_further(taken, share)
    if also.score > min(linear.score, found.score) - pays:
        return None
    joined = replace(also.state, added=_joined(also.state.added, also.effects[-1]))
    return replace(also, state=joined), _frequency(chosen)


def _joined(added: tuple[Added, ...], effect: str) -> tuple[Added, ...]:
    """Make one effect of those of one name: the last one goes to the one before."""
    *before, last = added
    return tuple(
        item._replace(
            blocks=(*item.blocks, *last.blocks), charge=item.charge + last.charge
        )
        if item.effect == effect
        else item
        for item in before
    )


def with_another_mode(state: ModelState) -> Iterator[ModelState]:
    """Take a mode out of what is beside a mechanism, as one of its own; each in turn.

    The model does what it did. The numbers of the mode are free, and come last.
    """
    first = next((x for x in state.chain if isinstance(x, Mechanism)), None)
    if first is None:
        return
    for place, block in enumerate(state.chain):
        if not isinstance(block, OtherModes):
            continue
        for one in taken_out(block, first.output):
            chain: tuple[Block, ...] | None
            if one.rest is None:
                chain = _passing(state.chain, place, one.direct, abs(one.through))
            else:
                chain = (*state.chain[:place], one.rest, *state.chain[place + 1 :])
            if chain is not None:
                yield _with_mode(state, chain, place, one.mode, one.rest is not None)


def _passing(
    chain: tuple[Block, ...], place: int, direct: float, size: float
) -> tuple[Block, ...] | None:
    """Let other modes pass at once what a block that leaves the chain did.

    None if there are no others, and it is more than nothing.
    """
    rest = list(chain)
    for k in reversed(range(len(chain))):
        block = chain[k]
        if k != place and isinstance(block, OtherModes):
            up = np.polyadd(block.numerator, direct * np.array(block.denominator))
            rest[k] = replace(block, numerator=tuple(up.tolist()))
            return tuple(rest)
    return chain if abs(direct) <= NONE * size else None


def _with_mode(
    state: ModelState, chain: tuple[Block, ...], place: int, mode: Mechanism, rest: bool
) -> ModelState:
    """Put a mode in before what is left of the block that it was in, or instead."""
    new = OtherMechanism(**{x.name: getattr(mode, x.name) for x in fields(mode)})
    behind = list(chain[place + (0 if rest else 1) :])
    blocks = (*chain[:place], new, *behind)
    moved = {k: k + (rest and k >= place) for k in range(len(chain))}
    with_numbers = {moved[x.block] for x in state.free}
    free = [x for x in state.free if not isinstance(state.chain[x.block], OtherModes)]
    state = replace(state, free=tuple(free)).rearranged(blocks, moved)
    free = list(state.free)
    for k in sorted(with_numbers):
        block = blocks[k]
        if isinstance(block, OtherModes):
            free += numbers_of(block, k)
    free += [Free(place, name) for name in NUMBERS]
    return replace(state, free=tuple(free)).settled()
