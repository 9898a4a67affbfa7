"""Blocks with memory of time: how their input moves between two samples."""

from collections.abc import Sequence
from dataclasses import replace
from typing import ClassVar, cast, get_args

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import choice
from hystbench.record import Hold as Hold

HOLDS: tuple[Hold, ...] = get_args(Hold)


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


def held_until_smooth(
    blocks: Sequence[Block], hold: Hold, was: Hold | None = None
) -> tuple[Block, ...]:
    """Give blocks another hold, up to the first that smooths; those of ``was`` alone.

    Parameters
    ----------
    blocks : sequence of Block
    hold : {"zero-order", "linear", "band-limited"}
    was : {"zero-order", "linear", "band-limited"}, optional
        Blocks of another hold than this are passed over.
    """
    found = list(blocks)
    for k, block in enumerate(found):
        if isinstance(block, HeldBlock) and was in (None, block.hold):
            found[k] = replace(block, hold=hold)
            if block.smooths:
                break
    return tuple(found)
