"""Hosts in place of a given base: with its numbers, and with fitted ones."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from hystbench.blocks.mechanism import Mechanism
from hystbench.gap.fitting.in_stages import fitted_far
from hystbench.gap.fitting.least_squares import fitted
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.inside.host import Host, Kind
from hystbench.gap.inside.one_coordinate import ZEROS
from hystbench.gap.thresholds import ABOUT, FURTHER


def as_given(
    kind: Kind,
    state: ModelState,
    about: ModelState,
    score: Score,
    words: str,
    free: tuple[Free, ...],
    exact: bool,
) -> Iterator[Host]:
    """Give a host that does what a given base does, then the same fitted to records.

    The numbers of a given base are known, unless it says that some are free. That known
    ones are wrong all the same has to pay as a further effect does. Numbers that the
    base states only roughly are so in the host too: ``about`` holds them by their
    tolerances. Modes are no numbers of a base, and their damping is seldom known.
    """
    if free:
        known = all(item.given is not None for item in free)
        own = fitted_far(about if known else state, score)
        yield Host(state, own, words, kind=kind)
        return
    held = replace(state, free=())
    as_they_are = f"{words}, its numbers as they are"
    yield Host(held, fitted(held, score), as_they_are, kind=kind)
    if not exact:
        words = f"{words}, its numbers fitted to the records"
        own = fitted_far(about, score)
        yield Host(state, own, words, charge=FURTHER, kind=kind)


def held_about(state: ModelState) -> ModelState:
    """Give a host whose numbers are held by what they may be off.

    Those that are counted from a zero are as they are.
    """

    def about(free: Free) -> Free:
        value, stated = state.value(free), free.given is not None
        if stated or free.parameter in ZEROS or value == 0.0:
            return free
        return free._replace(tolerance=ABOUT * abs(value), given=value)

    return replace(state, free=tuple(map(about, state.free)))


def is_seen_moving(state: ModelState) -> bool:
    """Tell whether a host's motion is slow enough for its records to show it.

    Of a mass whose poles both lie beyond the highest frequency of the samples only the
    static gain is seen. A force inside is then a static curve, which a chain has.
    """
    block = state.chain[0]
    if not isinstance(block, Mechanism):
        return True
    poles = np.roots([block.mass, block.damping, block.stiffness])
    step = min(record.dt for record in state.records)
    return bool(np.min(np.abs(poles)) < np.pi / step)
