"""Units of an effect's numbers: those of the signal at its place in the chain."""

from __future__ import annotations

import re

from hystbench.blocks.base import Block
from hystbench.gap.state import State


def written(unit: str, of_input: str, of_output: str) -> str:
    """Write the units of a model's input and of a block's output for U and Y."""
    units = {"U": of_input, "Y": of_output}
    words = re.findall(r"[A-Za-z]+|[^A-Za-z]+", unit)
    return "".join(units.get(word, word) for word in words)


def unit_behind(place: int, state: State) -> str:
    """Give the unit of the signal behind a block of the chain.

    It is the input's up to the block of the base that turns it into the output: the
    first that has a unit of both (a gain, a hysteresis, a simulator), or where there is
    none the last transfer function, which has no units of its own.
    """
    record = state.records[0]
    return (record.input if place < _turn(state) else record.output).unit


def _turn(state: State) -> int:
    own = {k for item in state.added for k in item.blocks}
    base = [k for k in range(len(state.chain)) if k not in own]
    # An effect may stand for all of the base, as what hardens takes a mode out of it.
    for places in (base, range(len(state.chain))):
        turning = [k for k in places if _has_both(state.chain[k])]
        if turning:
            return turning[0]
        linear = [k for k in places if state.chain[k].place == "base"]
        if linear:
            return linear[-1]
    return 0


def _has_both(block: Block) -> bool:
    units = [about.unit for about in block.parameters().values()]
    return block.hysteretic or not block.seen or "Y/U" in units
