"""``hysteresis``: the data have a loop at every rate, the chain has none."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from hystbench.envelope import Envelope
from hystbench.gap.effects.base import Declined, Effect, Values, Variant
from hystbench.gap.scene import Scene

OPERATORS = 8
LINEAR = 1e-3
"""Slope of the hyperbolic tangent where the envelope is to be a straight line."""


class Hysteresis(Effect):
    """Play operators before everything else, with envelopes that are straight lines.

    What other envelopes could do is spanned by reshaping, and charged.
    """

    name = "hysteresis"
    place = "material"

    def variants(self, scene: Scene) -> Iterator[Variant]:
        """Offer play operators over the range of the input."""
        if scene.hysteresis is not None:
            raise Declined("the chain has a hysteresis already")
        amplitude = scene.largest(0)
        thresholds = [float(x) for x in amplitude * np.arange(OPERATORS) / OPERATORS]
        slope = LINEAR / amplitude
        straight = dict.fromkeys(Envelope.__dataclass_fields__, 0.0)
        straight |= {"a0": 1 / slope, "a1": slope, "a4": 1 / slope, "a5": slope}
        names = [f"weight {k}" for k in range(1, OPERATORS)]

        def values(given: Values) -> dict[str, Any]:
            weights = [given[name] for name in names]
            # The first operator gives what the others leave of a gain of one.
            return {
                "envelope": straight,
                "thresholds": thresholds,
                "weights": [max(1.0 - sum(weights), 0.0), *weights],
            }

        yield self.inserted(
            scene,
            0,
            values,
            unit=dict.fromkeys(names, 1e-3),
            positive=tuple(names),
            free=("weights",),
        )
