"""A timing of an identified base that shows only once effects are beside it.

A base is identified with the gap in it. What follows too late by part of a sample is
then taken up by its poles and zeros, and stays beside the effects.
"""

from __future__ import annotations

from dataclasses import replace

from hystbench.blocks.base import Block
from hystbench.blocks.input_delay import InputDelay
from hystbench.blocks.other_modes import OtherModes
from hystbench.gap.fitting.edit_chain import rearranged
from hystbench.gap.fitting.least_squares import fitted_to_the_end
from hystbench.gap.fitting.model_score import score_of
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.records.floor import Floor
from hystbench.gap.thresholds import PAYS
from hystbench.model import Model

REACH = 1.0
"""Samples by which a record of the input may be early or late. What comes later than
that is no matter of sampling: it is an effect."""

TOLD = 0.05
"""Samples of timing that are worth a word: a twentieth of an interval."""


def better_timed(base: Model, found: ModelState, floor: Floor) -> Model | None:
    """Give an identified base with another timing, if that pays beside effects.

    Parameters
    ----------
    base : Model
    found : ModelState
        What stands for the base, with the effects that were found.
    floor : Floor

    Returns
    -------
    Model or None
        None where the score falls by less than an effect has to gain.
    """
    if any((x.block, x.parameter) == (0, "delay_s") for x in found.free):
        return None  # it was free beside the effects already
    if any(isinstance(block, OtherModes) for block in found.chain):
        return None  # the zeros of a structure of many modes hold it
    score = Score.plain(found.sample, floor.square)
    now = score_of(found, score)
    if now - score.least(found.freedom) < PAYS:
        return None
    best = fitted_to_the_end(with_free_timing(found), score)
    if not best.score < now - PAYS:
        return None
    return timed(base, _shift(best.state.chain[0]) - _shift(base.chain[0]))


def timed_as_named(base: Model, found: ModelState) -> Model | None:
    """Give a base with the delay that is named beside another effect.

    None without one, or where the input then comes later than by a sample.
    """
    named = sum(_shift(found.chain[place]) for place in found.places_added)
    late = sum(map(_shift, found.chain))
    if (
        named == 0.0
        or abs(late) > REACH * found.simulation.step
        or len(found.added) < 2
    ):
        return None
    return timed(base, late - _shift(base.chain[0]))


def in_time_words(found: ModelState) -> str:
    """Say by how much a base takes its input late; nothing where that hardly shows."""
    own = set(range(len(found.chain))) - found.places_added
    late = sum(_shift(found.chain[place]) for place in own)
    samples = abs(late) / found.simulation.step
    if samples < TOLD:
        return ""
    when = "late" if late > 0 else "early"
    return (
        f"the linear base takes its input {abs(late):.2g} s {when}, {samples:.2g} of a "
        "sampling interval"
    )


def timed(base: Model, later_s: float) -> Model:
    """Give a base that takes its input so many seconds later, or earlier."""
    behind = base.chain[1:] if isinstance(base.chain[0], InputDelay) else base.chain
    hold = next((x.hold for x in behind if hasattr(x, "hold")), "default")
    delay = InputDelay.by(_shift(base.chain[0]) + later_s, hold)
    return replace(base, chain=(delay, *behind))


def _shift(block: Block) -> float:
    """Give how late a block takes its input, in seconds."""
    return block.shift_s if isinstance(block, InputDelay) else 0.0


def in_front(block: Block, state: ModelState) -> ModelState:
    """Put a block before all others of a model."""
    moved = {k: k + 1 for k in range(len(state.chain))}
    return rearranged(state, (block, *state.chain), moved)


def with_free_timing(found: ModelState) -> ModelState:
    """Let a model take its input earlier or later, by a sample at most.

    The delay cannot be negative: a lead allows for both.
    """
    step = REACH * found.simulation.step
    first = found.chain[0]
    if isinstance(first, InputDelay):
        late = replace(first, delay_s=first.delay_s + step, lead_s=first.lead_s + step)
        state = found.with_blocks({0: late})
    else:
        late = InputDelay(delay_s=step, lead_s=step, hold=found.hold)
        state = in_front(late, found)
    free = tuple(x for x in state.free if (x.block, x.parameter) != (0, "delay_s"))
    own = Free(0, "delay_s", low=late.lead_s - step, high=late.lead_s + step)
    return replace(state, free=(own, *free)).settled()
