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
        """Offer the root of the level, and any power, in all stores alike."""
        values = {}
        for place, store, top in filled.tops:
            middle = top / 2  # where as much is to leave as before
            rate = store.rate * middle ** (store.exponent - ROOT)
            values[place] = {"exponent": ROOT, "rate": float(rate)}
        yield Changed("root", values, ())
        yield Changed("power", values, tuple((place, "exponent") for place in values))


ROOT = 0.5
"""Exponent of a free outlet."""
