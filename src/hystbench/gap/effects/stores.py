"""Laws of stores: how they run out, and where they overflow."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from hystbench.gap.effects.effect import StoreEffect
from hystbench.gap.effects.law import Changed, Filled


class Outflow(StoreEffect):
    """Outflow with a power of the level: a half for a free outlet (Torricelli)."""

    name = "outflow"
    shows = "amplitude"
    numbers = ("exponent",)

    def stored(self, filled: Filled) -> Iterator[Changed]:
        """Offer the root of the level, a weir, and any power, in all stores alike.

        As much is to leave as before where a store is half full. A linear outflow that
        is known is the tangent of the law at a level that its constant part tells:
        that part goes then.
        """
        for form, exponent in EXPONENTS.items():
            values = {}
            for place, store, top in filled.tops:
                rate = store.rate * (top / 2) ** (store.exponent - exponent)
                values[place] = {"exponent": exponent, "rate": float(rate)}
                level = 0.0
                if store.rate:
                    level = store.bias / store.rate * exponent / (exponent - 1.0)
                if filled.known and store.exponent == 1.0 and 0.0 < level <= top:
                    rate = store.rate * level ** (1.0 - exponent) / exponent
                    values[place] |= {"rate": float(rate), "bias": 0.0}
            # Where this is the law already another rate is no other law.
            changed = [x for x, store, _ in filled.tops if store.exponent != exponent]
            rates = tuple((place, "rate") for place in changed)
            powers = tuple((place, "exponent") for place in values)
            if changed:
                yield Changed(form, {place: values[place] for place in changed}, rates)
            yield Changed("power", values, (*rates, *powers))


EXPONENTS = {"root": 0.5, "weir": 1.5}
"""Exponents of a free outlet (Torricelli), and of water that flows over a straight
edge."""


SHARES = (0.95, 0.75)
"""Shares of the highest level without it: where overflow begins."""
CAUGHT = 0.3
"""Share of what is spilt that the next store catches, where a fit begins."""
EDGE = 0.5
"""Share of the highest level, at least, where a weir's edge lies: one below the levels
that a store has for most of the time is the law of its outlet."""
ABOVE = 0.1
"""Share of the highest level by which a level above a weir is, as a fit begins, where
as much runs over it as leaves below."""


class Overflow(StoreEffect):
    """What stores spill above a level, at once or over a weir: one, others, or all."""

    name = "overflow"
    shows = "amplitude"
    numbers = ("height", "caught", "weir")

    def stored(self, filled: Filled) -> Iterator[Changed]:
        """Offer heights met late and early; the next store catches a part.

        The last level is measured: it is seen where it stays. But a model without the
        overflow may rise higher, and spills nothing there. Over a weir the level goes
        on rising: its edge is met early.
        """
        last, _, highest = filled.tops[-1]
        lower = min(highest, filled.measured or highest)
        every = [place for place, *_ in filled.tops]
        groups = {"last": [last], "all": every, "upper": every[:-1]}
        for form, places in groups.items():
            if not places or (form == "all" and len(every) == 1):
                continue
            late, early = SHARES
            yield _spilling(filled, form, places, late, highest)
            yield _spilling(filled, form, places, early, lower)
            yield _spilling(filled, form, places, early, early * lower, over_weirs=True)


def _spilling(
    filled: Filled,
    form: str,
    places: Sequence[int],
    share: float,
    seen: float,
    over_weirs: bool = False,
) -> Changed:
    """Give stores that spill at shares of their tops; the last at a level seen."""
    last, *_ = filled.tops[-1]
    values: dict[int, dict[str, float]] = {}
    free: list[tuple[int, str]] = []
    ranges: dict[tuple[int, str], tuple[float, float]] = {}
    for place, store, top in filled.tops:
        if place not in places:
            continue
        own = values[place] = {"height": seen if place == last else share * top}
        if place != last:
            own["caught"] = CAUGHT
        if over_weirs:
            leaves = store.rate * top**store.exponent
            own["weir"] = leaves / (ABOVE * top) ** 1.5
            ranges[place, "height"] = (EDGE * (own["height"] / share), np.inf)
        free += [(place, name) for name in own]
    form += ", over a weir" * over_weirs
    return Changed(form, values, tuple(free), ranges)
