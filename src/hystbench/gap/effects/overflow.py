"""``overflow``: what would rise above the height of a store is spilt."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.gap.effects.effect import StoreEffect
from hystbench.gap.effects.law import Changed, Filled

SHARES = (0.95, 0.75)
"""Of the highest level without it: where overflow begins."""
CAUGHT = 0.3
"""Share of what is spilt that the next store catches, where a fit begins."""


class Overflow(StoreEffect):
    """What a store spills above a level: of the last store, the others, or all."""

    name = "overflow"
    shows = "amplitude"
    numbers = ("height", "caught")

    def stored(self, filled: Filled) -> Iterator[Changed]:
        """Offer heights met late and early; the next store catches a part.

        The last level is measured: it is seen where it stays. But a model without the
        overflow may rise higher, and spills nothing there.
        """
        last, _, highest = filled.tops[-1]
        lower = min(highest, filled.measured or highest)
        every = [place for place, *_ in filled.tops]
        groups = {"last": [last], "all": every, "upper": every[:-1]}
        for form, places in groups.items():
            if not places or (form == "all" and len(every) == 1):
                continue
            for share, seen in zip(SHARES, (highest, lower), strict=True):
                values, free = {}, []
                for place, _, top in filled.tops:
                    if place not in places:
                        continue
                    height = seen if place == last else share * top
                    values[place] = {"height": height}
                    free.append((place, "height"))
                    if place != last:
                        values[place]["caught"] = CAUGHT
                        free.append((place, "caught"))
                yield Changed(form, values, tuple(free))
