"""``hysteretic-force``: a force inside a mechanism that remembers the way."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from hystbench.blocks.bouc_wen_force import BoucWenForce
from hystbench.blocks.hysteretic_force import HystereticForce as Block
from hystbench.blocks.iwan_force import LEAST_EXPONENT, IwanForce
from hystbench.gap.effects.effect import ForceEffect
from hystbench.gap.effects.law import Law, Moved
from hystbench.gap.thresholds import SLIDES

STEEPEST = 1.0
"""Exponent of plays, at most. Of a joint it is below zero (Segalman); a large one makes
one way at which all slip, which is dry friction that gives way."""
LATEST = 0.5
"""Share of the slip distance at which the first plays slip, at most: with one that is
as late as the last all slip at once, too."""


class HystereticForce(ForceEffect):
    """Bouc and Wen's hysteresis as a force, or plays."""

    name = "hysteretic-force"
    shows = "branch"
    laws = ("bouc-wen-force", "iwan-force")

    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Offer it weak, with short and long ways to yield, or as one that stiffens."""
        names = ("largest", "yield_distance", "sharing")
        for share, way in ((0.03, 0.03), (0.1, 0.3), (0.3, 1.0)):
            block = Block(largest=share * moved.force, yield_distance=way * moved.reach)
            ranges = {"yield_distance": (SLIDES * moved.reach, np.inf)}
            yield Law("Bouc-Wen", block, names, ranges=ranges)
        # Beyond such a beta it would slide on nearly all of its way.
        stiffness = max(moved.stiffness, moved.force / moved.reach)
        stiffens = {
            "beta": (0.0, 1.0 / (SLIDES * moved.reach)),
            "gamma": (-np.inf, 0.0),
        }
        for share, softer, stiffer in ((0.1, 0.3, 0.3), (0.3, 1.0, 1.5)):
            wen = {
                "stiffness": share * stiffness,
                "beta": softer / moved.reach,
                "gamma": -stiffer / moved.reach,
            }
            yield Law(
                "Bouc-Wen, stiffer on loading",
                BoucWenForce(**wen),
                tuple(wen),
                ranges=stiffens,
            )
        plays = ("stiffness", "slip_distance", "exponent")
        for share, way in ((0.1, 0.3), (0.3, 1.0)):
            iwan = IwanForce(
                stiffness=share * stiffness, slip_distance=way * moved.reach
            )
            ranges = {
                "slip_distance": (SLIDES * moved.reach, np.inf),
                "exponent": (LEAST_EXPONENT, STEEPEST),
            }
            yield Law("plays", iwan, plays, ranges=ranges)
        late = IwanForce(
            stiffness=0.3 * stiffness,
            slip_distance=0.5 * moved.reach,
            exponent=-1.0,
            first_slip=0.1,
        )
        yield Law(
            "plays from a first slip on",
            late,
            (*plays, "first_slip"),
            ranges={
                "slip_distance": (SLIDES * moved.reach, np.inf),
                "exponent": (-np.inf, STEEPEST),
                "first_slip": (0.0, LATEST),
            },
        )

    def vanishing(self, form: str) -> Mapping[str, float]:
        """Without a loop it is a spring."""
        return {"beta": 0.0, "sharing": 1.0}
