"""Simulations that models share: the same chain on the same records is run once.

Models that differ in their scored samples, or in what may be re-tuned, often stand
beside each other.
"""

from __future__ import annotations

from functools import lru_cache

from hystbench.blocks.base import Block
from hystbench.blocks.held import Hold
from hystbench.gap.simulation.simulation import Simulation
from hystbench.record import Record


def quick(
    chain: tuple[Block, ...], records: tuple[Record, ...], hold: Hold
) -> Simulation:
    """Give the simulation by which models are compared."""
    return _shared(chain, _Same(records), hold, True)


def in_short_steps(
    chain: tuple[Block, ...], records: tuple[Record, ...], hold: Hold
) -> Simulation:
    """Give the simulation that misses least by its own steps."""
    return _shared(chain, _Same(records), hold, False)


class _Same:
    """Records as a key: these, and not others of the same samples."""

    def __init__(self, records: tuple[Record, ...]) -> None:
        self.records = records

    def __hash__(self) -> int:
        return id(self.records)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and self.records is other.records


@lru_cache(maxsize=8)
def _shared(
    chain: tuple[Block, ...], given: _Same, hold: Hold, quick: bool
) -> Simulation:
    return Simulation(chain, given.records, hold, quick=quick, fine=not quick)
