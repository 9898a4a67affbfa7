"""What the named effects cannot own of what they leave: how much, and of what sort."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from hystbench.gap.judging.known_signals import SLOW_POWER
from hystbench.gap.thresholds import LOOSE, UNNAMED_SHARE, WORTH_A_WORD

OVER_RECORDS = "changes with time or between records, perhaps with level"
SORTS = {
    "strength": f"the strength of what is named {OVER_RECORDS}",
    "gain": f"the gain of the whole {OVER_RECORDS}",
    "path": "each record has a slow path of its own",
    "history": "it depends on how hard the device was driven before",
    "memory": "it has memory or delay of another kind",
    "curve": "it is a curve or a loop of another kind",
    "unrelated": "it does not follow the recorded input in any way that was tried",
}
"""What is said of each sort of structure."""
SORT_OF = {
    "strength": "strength",
    "gain": "gain",
    "path": "path",
    SLOW_POWER: "history",
    "dynamics": "memory",
    "rate": "memory",
    "statics": "curve",
    "memory": "curve",
}
"""Sort of a residual that a group of columns explains best."""


@dataclass(frozen=True)
class Unowned:
    """What the names cannot own, as shares of the power of the gap above the floor."""

    structured: float
    """What follows known signals and the named effects cannot own."""
    allowed: float = UNNAMED_SHARE
    """Share of it that may stay."""
    changing: float | None = None
    """What goes if the effects' strength and numbers may differ between the halves of
    each recording, a record or all windows cut from one; None where no effect acts
    on the input. It is told and decides nothing: what changes in time is structure
    too."""
    unrelated: float = 0.0
    """What follows no known signal."""
    gains: Mapping[str, float] = field(default_factory=dict)
    """How far each group of known signals, alone, raises the evidence, in natural
    logarithms; empty where so little stays that no sort is said."""
    factors: tuple[float, ...] = ()
    """The effects' strength in each record, as a multiple of what it is in all of them;
    empty where no effect acts on the input."""
    by_chance: float = 0.0
    """What seems to follow known signals, but does so no more than when it is moved in
    time against them; it counts as unrelated."""

    @property
    def stays(self) -> float:
        """Share of the gap that the names leave beyond what they may own."""
        return self.structured + self.unrelated

    @property
    def too_much(self) -> bool:
        """Whether more follows known signals, without being owned, than is allowed."""
        return self.structured > self.allowed

    @property
    def told(self) -> bool:
        """Whether so much stays that its sort is said."""
        return self.too_much or self.stays > LOOSE

    @property
    def follows_nothing(self) -> bool:
        """Whether much stays, and no more of it than may follows known signals."""
        return self.stays > LOOSE and not self.too_much

    def trust(self, of_base: bool = False) -> float:
        """Give the factor on a name's confidence: one where no more stays than may.

        Else it is the allowed over the actual share. Where the base may have left that
        as well, it is the square root of that share, halfway to one on a logarithmic
        scale.
        """
        factor = self.allowed / self.structured if self.too_much else 1.0
        return math.sqrt(factor) if of_base else factor

    @property
    def sort(self) -> str:
        """Sort of what stays: a key of :data:`SORTS`."""
        best = max(self.gains, key=lambda name: self.gains[name], default=None)
        lone = self.structured < WORTH_A_WORD * self.stays
        if best is None or self.gains[best] <= 0 or lone:
            return "unrelated"
        return SORT_OF[best]

    @property
    def reason(self) -> str:
        """Why no name stands."""
        return (
            f"{100 * self.structured:.2g} % of the gap's power follows known signals, "
            "and no parameter values of the named effects explain it: "
            f"{SORTS[self.sort]}"
        )

    def mapping(self) -> dict[str, Any]:
        """Give what gap.json holds: no sort where no more stays than may."""
        sort = self.sort if self.told else None
        return {
            "allowed": self.allowed,
            "structured": self.structured,
            "changing": self.changing,
            "by_chance": self.by_chance,
            "unrelated": self.unrelated,
            "sort": sort,
            "sentence": SORTS[sort] if sort else None,
            "factors": list(self.factors),
        }
