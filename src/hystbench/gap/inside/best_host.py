"""Which of several linear hosts fits best."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from hystbench.blocks.mechanism import Mechanism
from hystbench.gap.fitting.least_squares import QUICK, Fitted, fitted
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState


def best_host(states: Sequence[ModelState], score: Score) -> Fitted | None:
    """Fit linear hosts, the likely ones to the end; give the one that scores least.

    What it gives as its output may also have a share of the next derivative (a zero).
    """
    if not states:
        return None
    quick = [fitted(state, score, QUICK) for state in states]
    best = fitted(min(quick, key=lambda item: item.score).state, score)
    for further in with_zero(best.state):
        found = fitted(further, score)
        if found.score < best.score:
            best = found
    return best


def with_zero(state: ModelState) -> Iterator[ModelState]:
    """Give a mechanism with a zero in its numerator."""
    block = state.chain[0]
    if isinstance(block, Mechanism) and block.output != "force":
        yield replace(state, free=(*state.free, Free(0, "blend")))
