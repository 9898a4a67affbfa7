"""``gravity``: the moment of a weight that turns."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from hystbench.blocks.gravity import RADIANS
from hystbench.blocks.gravity import Gravity as GravityBlock
from hystbench.gap.effects.effect import ForceEffect
from hystbench.gap.effects.law import Law, Moved

BESIDE = 2.0
"""Of a spring that is known, as of an arm that was measured lying: a weight that is
more than the spring is far from any share of it."""


class Gravity(ForceEffect):
    """The weight of a pendulum, by the sine of its angle."""

    name = "gravity"
    shows = "amplitude"
    special = True
    taken_from = "stiffness"

    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Offer a weight that makes half of the spring, one against it, one beside it.

        The coordinate is an angle. It is counted from the vertical, or from any angle:
        from where the weight is at rest, or from where the spring is.
        """
        both = ("amplitude", "angle")
        starts = (BESIDE, 0.5, -0.5) if moved.turns and not moved.anywhere else ()
        for share in starts:
            # Of so small an angle that its sine is the angle, a spring.
            weight = share * moved.stiffness / RADIANS[moved.turns]
            block = GravityBlock(amplitude=weight, unit=moved.turns)
            part = share if share < 1 else 0.0
            yield Law("", block, both[:1], stands_for=part)
            yield Law("tilted", block, both, stands_for=part)
            slack = replace(block, carried=0.0)
            yield Law("tilted, from a slack spring", slack, both, stands_for=part)
