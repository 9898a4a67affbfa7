"""``stop``: a contact inside a mechanism beyond a clearance."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from hystbench.blocks.stop import SIDES
from hystbench.blocks.stop import Stop as StopBlock
from hystbench.gap.effects.effect import ForceEffect
from hystbench.gap.effects.law import Law, Moved


class Stop(ForceEffect):
    """Contact beyond a clearance, on one side or both."""

    name = "stop"
    shows = "amplitude"

    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Offer both sides, and either one, met early and late."""
        stiffness = moved.force / moved.reach
        for sides in () if moved.anywhere else SIDES:
            for share in (0.3, 0.8):
                block = StopBlock(
                    contact_stiffness=stiffness, gap=share * moved.reach, sides=sides
                )
                yield Law(_form(sides), block, ("contact_stiffness", "gap"))

    def vanishing(self, form: str) -> Mapping[str, float]:
        """Without its clearance a stop on both sides is a linear spring."""
        return {"gap": 0.0} if form == _form("both") else {}


def _form(sides: str) -> str:
    return f"sides: {sides}"
