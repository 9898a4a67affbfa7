"""A chain of linear dynamics that begins otherwise."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from hystbench.blocks.base import Block
from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.mechanism import Mechanism, free_starts
from hystbench.blocks.starts import PASTS
from hystbench.blocks.structure import Structure
from hystbench.blocks.transfer_function import TransferFunction


def starting(chain: Sequence[Block], start: str) -> tuple[Block, ...]:
    """Give linear dynamics another start; a free mass has only some.

    Where the dynamics are at rest, a lag that is not is settled.
    """

    def begun(block: Any) -> Any:
        wanted = own = getattr(block, "start", "rest")
        if isinstance(block, Mechanism):
            may = block.stiffness > 0.0 or start in free_starts(block.output)
            wanted = start if may else own
        elif isinstance(block, Structure | TransferFunction):
            wanted = start
        elif isinstance(block, LinearBlock):
            at_rest = "settled" if own in PASTS else own
            wanted = at_rest if start == "rest" else start
        return block if wanted == own else replace(block, start=wanted)

    return tuple(map(begun, chain))
