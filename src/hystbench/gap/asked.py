"""What a user asks of a search."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from hystbench.gap.progress import Say, silent
from hystbench.gap.thresholds import UNNAMED_SHARE
from hystbench.gap.vocabulary import EVERYTHING, Vocabulary


@dataclass(frozen=True, kw_only=True)
class Asked:
    """Limits, shares and names, and who is told how far the search is."""

    limits: Mapping[str, float] | None = None
    """What the next experiment may ask of the actuator: ``low``, ``high``, ``rate``.
    What is not given is taken from the fit records."""
    unnamed_share: float = UNNAMED_SHARE
    """Share of the gap's power that may stay unnamed beside a name. The verdict
    compares it with what follows known signals. The search compares it with all that
    is left, and takes at most the default (:attr:`sought`)."""
    vocabulary: Vocabulary = EVERYTHING
    """Effects that may be named, and those that are in the model from the start."""
    say: Say = silent
    """Told a line of progress at a time."""

    @property
    def sought(self) -> Asked:
        """The same for the search: to let more stay is no reason to look for less."""
        return replace(self, unnamed_share=min(self.unnamed_share, UNNAMED_SHARE))


USUAL = Asked()
"""Nothing but what is usual."""
