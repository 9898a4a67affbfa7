"""Contacts inside a mechanism: a slider behind a clearance, and stops."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.slider_with_gap import SliderWithGap as SliderBlock
from hystbench.blocks.stop import SIDES
from hystbench.blocks.stop import Stop as StopBlock
from hystbench.gap.effects.effect import InsideEffect
from hystbench.gap.effects.law import Law, Moved
from hystbench.gap.thresholds import SLIDES

SLIDER_SHARES = (0.03, 0.1, 0.3)
"""Of the largest way, by which a slider's clearance and its spring are begun."""


class SliderWithGap(InsideEffect):
    """A slider behind a clearance."""

    name = "slider-with-gap"
    shows = "branch"

    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Offer narrow and wide clearances, behind which it slides early or late.

        A clearance of next to nothing is none, but how dry friction gives way.
        """
        names = ("contact_stiffness", "slip_force", "gap")
        for share, slides in itertools.product(SLIDER_SHARES, SLIDER_SHARES):
            block = SliderBlock(
                contact_stiffness=0.3 * moved.force / (slides * moved.reach),
                slip_force=0.3 * moved.force,
                gap=share * moved.reach,
            )
            ranges = {"gap": (SLIDES * moved.reach, np.inf)}
            yield Law("", block, names, ranges=ranges)

    def vanishing(self, form: str, block: Any) -> Iterator[tuple[Block, str]]:
        """Without its clearance it is dry friction."""
        yield replace(block, gap=0.0), "gap"


SLACK = 0.9
"""Of a linear spring that a contact stands for, as of a shaft with play: it carries
nothing within the clearance. A rest of the spring stays, for a fit to take or leave."""
HERTZ = 1.5
"""Power of the way in, of round bodies."""
LOSS = 0.3
"""Share of a contact's force that a start adds at the largest speed."""


class Stop(InsideEffect):
    """Contact beyond a clearance, on one side or both."""

    name = "stop"
    shows = "amplitude"

    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Offer both sides, and either one, met early and late, and one that loses.

        Of both sides one may be nearer than the other. Where there is a spring the
        clearance may also be in it.
        """
        stiffness = moved.force / moved.reach
        numbers = ("contact_stiffness", "gap")
        for sides in () if moved.anywhere else SIDES:
            apart = ("centre",) if sides == "both" else ()
            for share in (0.3, 0.8):
                block = StopBlock(
                    contact_stiffness=stiffness, gap=share * moved.reach, sides=sides
                )
                yield Law(_form(sides), block, numbers)
                if apart:
                    yield Law(UNEVEN, block, (*numbers, *apart))
            # Round bodies are soft at first: as stiff as others half as far in.
            softer = (0.5 * (1 - share) * moved.reach) ** (1 - HERTZ)
            round_ = replace(
                block, contact_stiffness=stiffness * softer, exponent=HERTZ
            )
            yield Law(f"{_form(sides)}, round", round_, numbers)
            if apart and moved.stiffness > 0.0:
                slack = replace(
                    block, contact_stiffness=moved.stiffness, gap=0.1 * moved.reach
                )
                yield Law(_form(sides), slack, numbers, stands_for=SLACK)
            lossy = replace(block, loss=LOSS / moved.speed)
            form = UNEVEN if apart else _form(sides)
            yield Law(f"{form}, lossy", lossy, (*numbers, *apart, "loss"))

    def vanishing(self, form: str, block: Any) -> Iterator[tuple[Block, str]]:
        """Without its clearance a stop on both sides is a linear spring."""
        if form in (_form("both"), UNEVEN):
            yield replace(block, gap=0.0), "gap"


def _form(sides: str) -> str:
    return f"sides: {sides}"


UNEVEN = _form("both, uneven")
