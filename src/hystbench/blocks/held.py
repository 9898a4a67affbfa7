"""Blocks with memory of time: how their input moves between two samples."""

from typing import ClassVar, Literal, cast

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import choice

Hold = Literal["zero-order", "linear", "band-limited"]
HOLDS: tuple[Hold, ...] = ("zero-order", "linear", "band-limited")


class HeldBlock(Block):
    """A block whose output depends on the input between the samples.

    ``default`` stands for :attr:`own_hold`, unless ``Model.with_hold`` sets another.
    """

    own_hold: ClassVar[Hold] = "linear"
    smooths: ClassVar[bool] = True
    """Whether a staircase is none any more behind the block."""

    hold: str = choice(
        "how the input moves between two samples", ("default", *HOLDS), "default"
    )

    @property
    def holding(self) -> Hold:
        """What ``hold`` comes to."""
        return self.own_hold if self.hold == "default" else cast(Hold, self.hold)
