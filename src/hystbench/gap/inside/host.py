"""A linear host: what forces can act inside of, fitted without any of them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from hystbench.blocks.mechanism import Mechanism
from hystbench.gap.fitting.least_squares import QUICK, Fitted, fitted
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.thresholds import ABOUT

ZEROS = ("bias", "offset", "delay_s", "blend")
"""Numbers that are counted from a zero: a share of them says nothing."""


@dataclass(frozen=True)
class Host:
    """A linear model that forces may act inside of."""

    alone: ModelState
    """What the gap is counted from."""
    fitted: Fitted
    """The same, its numbers fitted to the records: what forces are put in."""
    words: str
    """How it stands in place of the base."""
    other: ModelState | None = None
    """What forces are put in instead: as good while linear, and not fitted, as a fit
    would come back."""
    charge: float = 0.0
    """For numbers of a given base that are fitted though nobody set them free."""

    @property
    def counts(self) -> int:
        """As how many effects it counts: one if known numbers are fitted."""
        return int(self.charge > 0.0)


def about_what_is_given(state: ModelState, free: Free) -> Free:
    """Give a number with what it may be off; one that is counted from a zero as is."""
    value = state.value(free)
    if free.given is not None:  # its tolerance is stated
        return free
    if free.parameter in ZEROS or value == 0.0:
        return free
    return free._replace(tolerance=ABOUT * abs(value), given=value)


def best_host(states: Iterable[ModelState], score: Score) -> Fitted | None:
    """Fit linear hosts, the likely ones to the end; give the one that scores least.

    What it gives as its output may also have a share of the next derivative (a zero).
    """
    best = likeliest(states, score)
    if best is None:
        return None
    return min(best, with_a_zero(best, score), key=lambda item: item.score)


def likeliest(states: Iterable[ModelState], score: Score) -> Fitted | None:
    """Fit hosts a little, and the best of them to the end; None without any."""
    quick = [fitted(state, score, QUICK) for state in states]
    if not quick:
        return None
    return fitted(min(quick, key=lambda item: item.score).state, score)


def with_a_zero(best: Fitted, score: Score) -> Fitted:
    """Fit a host whose output also has a share of the next derivative."""
    block, free = best.state.chain[0], best.state.free
    zero = Free(0, "blend")
    if not (isinstance(block, Mechanism) and block.output != "force") or zero in free:
        return best
    return fitted(replace(best.state, free=(*free, zero)), score)
