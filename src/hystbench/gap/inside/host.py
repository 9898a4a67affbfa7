"""A linear host: what forces may act inside of, and what it stands for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from hystbench.gap.fitting.least_squares import Fitted
from hystbench.gap.fitting.state import ModelState

Kind = Literal["stores", "coordinate", "loose mass", "two masses", "given", "structure"]
"""What a host is made of."""


@dataclass(frozen=True)
class Host:
    """A linear model that forces may act inside of."""

    alone: ModelState
    """What the gap is counted from."""
    fitted: Fitted
    """The same, its numbers fitted to the records: what forces are put in."""
    words: str
    """How it stands in place of the base."""
    other: ModelState | None = None
    """What forces are put in instead: as good while linear, and not fitted, as a fit
    would come back."""
    charge: float = 0.0
    """Charge for numbers of a given base that are fitted though nobody set them
    free."""
    kind: Kind = "coordinate"
    carry: Callable[[ModelState], ModelState] | None = None
    """Makes a model in the host before this one a model in this. What did best there
    is fitted on, and no other force is tried anew."""

    @property
    def counts(self) -> int:
        """As how many effects it counts: one if known numbers are fitted."""
        return int(self.charge > 0.0)
