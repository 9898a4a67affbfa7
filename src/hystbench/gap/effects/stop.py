"""``stop``: a contact inside a mechanism beyond a clearance."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from hystbench.blocks.stop import SIDES
from hystbench.blocks.stop import Stop as StopBlock
from hystbench.gap.effects.effect import ForceEffect
from hystbench.gap.effects.law import Law, Moved

LOSS = 0.3
"""Of a contact's force that a start adds at the largest speed."""


class Stop(ForceEffect):
    """Contact beyond a clearance, on one side or both."""

    name = "stop"
    shows = "amplitude"

    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Offer both sides, and either one, met early and late, and one that loses."""
        stiffness = moved.force / moved.reach
        for sides in () if moved.anywhere else SIDES:
            for share in (0.3, 0.8):
                block = StopBlock(
                    contact_stiffness=stiffness, gap=share * moved.reach, sides=sides
                )
                yield Law(_form(sides), block, ("contact_stiffness", "gap"))
            lossy = replace(block, loss=LOSS / moved.speed)
            numbers = ("contact_stiffness", "gap", "loss")
            yield Law(f"{_form(sides)}, lossy", lossy, numbers)

    def vanishing(self, form: str) -> Mapping[str, float]:
        """Without its clearance a stop on both sides is a linear spring."""
        return {"gap": 0.0} if form == _form("both") else {}


def _form(sides: str) -> str:
    return f"sides: {sides}"
