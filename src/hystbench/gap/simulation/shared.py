"""Simulations that models share: the same chain on the same records is run once.

Models that differ in their scored samples, or in what may be re-tuned, often stand
beside each other.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from hystbench.blocks.base import Block
from hystbench.blocks.held import Hold
from hystbench.gap.simulation.simulation import Simulation, Steps
from hystbench.record import Record


def shared(
    chain: tuple[Block, ...], records: tuple[Record, ...], hold: Hold, steps: Steps
) -> Simulation:
    """Give a simulation: the one that was given before, of the same."""
    return _shared(chain, Same(records), hold, steps)


class Same:
    """Objects as a key: these, and not others that are equal."""

    def __init__(self, *objects: Any) -> None:
        self.objects = objects

    def __hash__(self) -> int:
        return hash(tuple(map(id, self.objects)))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Same) and list(map(id, self.objects)) == list(
            map(id, other.objects)
        )


@lru_cache(maxsize=8)
def _shared(
    chain: tuple[Block, ...], given: Same, hold: Hold, steps: Steps
) -> Simulation:
    (records,) = given.objects
    return Simulation(chain, records, hold, steps)
