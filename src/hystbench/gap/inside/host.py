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
    unfitted_start: ModelState | None = None
    """A start for forces that is as good while linear. It is not fitted: a fit would
    lead back to ``fitted``."""
    charge: float = 0.0
    """Charge for numbers of a given base that are fitted though nobody set them
    free."""
    kind: Kind = "coordinate"
    carry: Callable[[ModelState], ModelState] | None = None
    """Turns a model in the previous host into one in this. Its best model is then
    fitted on; no other force is tried."""

    @property
    def counts(self) -> int:
        """How many effects it counts as: one if known numbers were fitted, else 0."""
        return int(self.charge > 0.0)
