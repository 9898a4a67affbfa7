"""``gravity``: the moment of a weight that turns."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from hystbench.blocks.gravity import RADIANS
from hystbench.blocks.gravity import Gravity as GravityBlock
from hystbench.gap.effects.effect import ForceEffect
from hystbench.gap.effects.law import Law, Moved


class Gravity(ForceEffect):
    """The weight of a pendulum, by the sine of its angle."""

    name = "gravity"
    shows = "amplitude"
    special = True
    taken_from = "stiffness"

    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Offer a weight that makes half of the spring, and one that works against it.

        The coordinate is an angle. It is counted from the vertical, or from any angle:
        from where the weight is at rest, or from where the spring is.
        """
        both = ("amplitude", "angle")
        for share in (0.5, -0.5) if moved.turns and not moved.anywhere else ():
            # Of so small an angle that its sine is the angle, a spring.
            weight = share * moved.stiffness / RADIANS[moved.turns]
            block = GravityBlock(amplitude=weight, unit=moved.turns)
            yield Law("", block, both[:1], stands_for=share)
            yield Law("tilted", block, both, stands_for=share)
            slack = replace(block, carried=0.0)
            yield Law("tilted, from a slack spring", slack, both, stands_for=share)
