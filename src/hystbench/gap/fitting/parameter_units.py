"""Units of a block's numbers: those of the signals at its place in the chain."""

from __future__ import annotations

import re
from collections.abc import Sequence

from hystbench.blocks.base import Block
from hystbench.blocks.force import Dynamics, Force
from hystbench.blocks.impedance import Impedance
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.store import Store
from hystbench.blocks.structure import Structure
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.thresholds import ABOUT

ORDERS = {"position": 0, "velocity": 1, "acceleration": 2}
"""Derivatives of the coordinate."""


def unit_written(unit: str, of_input: str, of_output: str) -> str:
    """Write the units of a model's input and of a block's output for U and Y."""
    return _put(unit, {"U": of_input, "Y": of_output})


def unit_at(
    unit: str, chain: Sequence[Block], place: int, of_input: str, of_output: str
) -> str:
    """Write the unit of a number of a block in a chain.

    A force inside a mechanism is measured in the unit of what drives it, the input
    times a gain; inside an impedance, in that of the output. Q is the unit of the
    coordinate.

    Parameters
    ----------
    unit : str
        As the block tells it, in U, Y and Q.
    chain : sequence of Block
    place : int
        Of the block.
    of_input, of_output : str
        Units of the model's input and of the signal behind the block.
    """
    inside = isinstance(chain[place], Force)
    while place > 0 and isinstance(chain[place], Force):
        place -= 1
    host = chain[place]
    units = {"U": of_input, "Y": of_output}
    if isinstance(host, Impedance):
        order, way = ORDERS[host.input], of_input
        units["U"] = of_output if inside else of_input
    elif isinstance(host, Mechanism | Structure) and host.output in ORDERS:
        order, way = ORDERS[host.output], of_output
        # A gain of one that a fit has re-tuned is one still.
        if abs(getattr(host, "gain", 1.0) - 1.0) > ABOUT:
            units["U"] = f"gain*{of_input}"
    elif isinstance(host, Store):
        order, way = (0, of_output) if host.output == "level" else (1, of_input)
    else:
        return _put(unit, units)
    for derivative, word in ((2, r"Q/s\^2"), (1, r"Q/s(?!\^)"), (0, r"Q(?!\d)")):
        unit = re.sub(word, f"Q{derivative}", unit)
    return _put(unit, units | {f"Q{k}": _derived(way, k - order) for k in range(3)})


def _put(unit: str, units: dict[str, str]) -> str:
    words = re.findall(r"Q\d|[A-Za-z]+|[^A-Za-z]+?(?=[A-Za-z]|$)", unit)
    found = [units.get(word, word) for word in words]
    if len(words) > 1:
        found = [
            f"({x})" if x != word and re.search("[ /]", x) else x
            for x, word in zip(found, words, strict=True)
        ]
    return "".join(found)


def _derived(unit: str, times: int) -> str:
    """Write the unit of a derivative, or of what this is a derivative of."""
    if times == 0:
        return unit
    per = {1: "/s", 2: "/s^2"}
    if times > 0:
        return unit + per[times]
    for order in (2, 1):
        root = unit.removesuffix(per[order])
        if root != unit and order >= -times:
            return _derived(root, order + times)
    return f"{unit} s" if times == -1 else f"{unit} s^2"


def unit_behind(place: int, state: ModelState) -> str:
    """Give the unit of the signal behind a block of the chain.

    It is the input's up to the block of the base that turns it into the output: the
    first that has a unit of both (a gain, a hysteresis, a mechanism, a simulator), or
    where there is none the last transfer function, which has no units of its own.
    """
    record = state.records[0]
    return (record.input if place < _turn(state) else record.output).unit


def _turn(state: ModelState) -> int:
    own = state.places_added
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
    if isinstance(block, Dynamics | Store):
        return True
    units = [about.unit for about in block.parameters().values()]
    return block.hysteretic or not block.seen or "Y/U" in units
