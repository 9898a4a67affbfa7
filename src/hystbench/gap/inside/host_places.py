"""Hosts in a chain: the blocks that forces can be put inside of, and their numbers."""

from __future__ import annotations

from collections.abc import Sequence

from hystbench.blocks.base import Block
from hystbench.blocks.impedance import NUMBERS, Impedance
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.structure import Structure
from hystbench.gap.fitting.state import Free, ModelState

LINEAR = NUMBERS[:-1]
"""Numbers of the linear part of a mechanism."""
MODES = ("stiffness", "damping", "modal_constant", "blend")
"""Numbers of each mode of a structure."""


def host_of(state: ModelState) -> int:
    """Give the place of what forces are put inside of: the last host of the chain."""
    return host_places(state.chain)[-1]


def own_numbers(state: ModelState, place: int) -> tuple[Free, ...]:
    """Give the numbers that a host has itself as free ones.

    What drives a mechanism has none of its own: it would be one of mass, damping and
    stiffness together.
    """
    block = state.chain[place]
    if isinstance(block, Structure):
        every = (
            Free(place, name, k)
            for name in MODES
            for k in range(len(getattr(block, name)))
        )
        return tuple(free for free in every if state.value(free) != 0.0)
    names = NUMBERS if isinstance(block, Impedance) else LINEAR
    return tuple(Free(place, name) for name in names if getattr(block, name) != 0.0)


def host_places(chain: Sequence[Block]) -> list[int]:
    """Give the places of the blocks of a chain that forces may be put inside of."""
    hosts = (Mechanism, Impedance, Structure)
    return [k for k, block in enumerate(chain) if isinstance(block, hosts)]
