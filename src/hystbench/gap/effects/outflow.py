"""``outflow``: what leaves a store goes with a power of its level."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.gap.effects.effect import StoreEffect
from hystbench.gap.effects.law import Changed, Filled


class Outflow(StoreEffect):
    """Outflow with a power of the level: a half for a free outlet (Torricelli)."""

    name = "outflow"
    shows = "amplitude"
    numbers = ("exponent",)

    def stored(self, filled: Filled) -> Iterator[Changed]:
        """Offer the root of the level, and any power, in all stores alike.

        As much is to leave as before where a store is half full. A linear outflow that
        is known is the tangent of the root at a level that its constant part tells:
        that part goes then.
        """
        values = {}
        for place, store, top in filled.tops:
            rate = store.rate * (top / 2) ** (store.exponent - ROOT)
            values[place] = {"exponent": ROOT, "rate": float(rate)}
            level = -store.bias / store.rate if store.rate else 0.0
            if filled.known and store.exponent == 1.0 and 0.0 < level <= top:
                rate = store.rate * level ** (1.0 - ROOT) / ROOT
                values[place] = {"exponent": ROOT, "rate": float(rate), "bias": 0.0}
        # Where the law is the root already another rate is no other law.
        changed = [x for x, store, _ in filled.tops if store.exponent != ROOT]
        rates = tuple((place, "rate") for place in changed)
        powers = tuple((place, "exponent") for place in values)
        if changed:
            yield Changed("root", {place: values[place] for place in changed}, rates)
        yield Changed("power", values, (*rates, *powers))


ROOT = 0.5
"""Exponent of a free outlet."""
