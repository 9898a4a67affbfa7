"""The cap on a name's confidence where hold-out records do not bear it out.

``content`` is what gap.json holds.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from hystbench.gap.effects import effects
from hystbench.gap.holdout.shortfall import is_beside, kept_share, steps_up
from hystbench.gap.thresholds import MOST


def no_surer_than_even(content: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Give the effects, no surer than even where hold-out records do not bear them out.

    Confidence is capped at 0.5 for a name whose step widens the gap there. If less than
    half of the share that is gone on the fit records is gone there, it is capped for
    all names but signals that are new in every record.
    """
    doubtful = {
        name for _, step in steps_up(content) for name in step["name"].split(" + ")
    }
    promised, kept = content["fit"]["explained"], kept_share(content)
    if promised is not None and kept is not None and kept < MOST * promised:
        names = [item["name"] for item in content["effects"]]
        doubtful |= {name for name in names if not is_beside(effects()[name])}
    return [
        item | {"confidence": min(item["confidence"], MOST)}
        if item["name"] in doubtful
        else item
        for item in content["effects"]
    ]
