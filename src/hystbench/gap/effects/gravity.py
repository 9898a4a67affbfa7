"""``gravity``: the moment of a weight that turns."""

from __future__ import annotations

from collections.abc import Iterator

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

        The coordinate is an angle. It is counted from the vertical, or from any angle.
        """
        for share in (0.5, -0.5) if moved.turns and not moved.anywhere else ():
            block = GravityBlock(amplitude=share * moved.stiffness)
            for form, free in (
                ("", ("amplitude",)),
                ("tilted", ("amplitude", "angle")),
            ):
                yield Law(form, block, free, stands_for=share)
