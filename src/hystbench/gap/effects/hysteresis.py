"""``hysteresis``: the data have a loop at every rate, the chain has none."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np

from hystbench.envelope import Envelope
from hystbench.gap.effects.base import Declined, Effect, Values, Variant
from hystbench.gap.scene import Scene

OPERATORS = 8
BEND = 0.5
"""Argument of the hyperbolic tangent at the largest input, where the search starts."""
PLAYS = "prandtl-ishlinskii"
POWERS: dict[str, tuple[str, ...]] = {
    "plays": ("weights",),
    "plays, odd": ("weights", "cube_weights"),
}
"""Numbers by form: of plays alone, and of plays whose branches bend."""


class Hysteresis(Effect):
    """Play operators before everything else, plain ones or generalized ones.

    Plain plays lie beside a linear path: the chain has its gain already. Their weights
    may have any sign. Generalized ones have envelopes, from nearly straight and alike
    ones on; the refit bends them.
    """

    name = "hysteresis"
    place = "material"
    laws: ClassVar = (PLAYS,)

    def variants(self, scene: Scene) -> Iterator[Variant]:
        """Offer operators over the range of the input."""
        if scene.hysteresis is not None:
            raise Declined("the chain has a hysteresis already")
        if scene.loop is not None and scene.chain[scene.loop].reruns:
            raise Declined("the simulator has a hysteresis already")
        yield self._generalized(scene)
        for form, powers in POWERS.items():
            yield self._plays(scene, form, powers)

    def _plays(self, scene: Scene, form: str, powers: tuple[str, ...]) -> Variant:
        """Plays beside a linear path, and powers of them."""
        amplitude = scene.largest(0)
        thresholds = [float(x) for x in amplitude * np.arange(OPERATORS) / OPERATORS]
        names = {key: [f"{key} {k}" for k in range(OPERATORS)] for key in powers}
        size = {
            "weights": 1e-3,
            "square_weights": 1e-3 / amplitude,
            "cube_weights": 1e-3 / amplitude**2,
        }

        def values(given: Values) -> dict[str, Any]:
            own = {key: [given[name] for name in names[key]] for key in powers}
            return {"thresholds": thresholds, **own}

        unit = {name: size[key] for key in powers for name in names[key]}
        return self.inserted(
            scene,
            0,
            values,
            law=PLAYS,
            form=form,
            unit=unit,
            free=powers,
        )

    def _generalized(self, scene: Scene) -> Variant:
        amplitude = scene.largest(0)
        thresholds = [float(x) for x in amplitude * np.arange(OPERATORS) / OPERATORS]
        slope = BEND / amplitude
        envelope = dict.fromkeys(Envelope.__dataclass_fields__, 0.0)
        envelope |= {"a0": 1 / slope, "a1": slope, "a4": 1 / slope, "a5": slope}
        names = [f"weight {k}" for k in range(1, OPERATORS)]

        def values(given: Values) -> dict[str, Any]:
            weights = [given[name] for name in names]
            # The first operator gives what the others leave of a gain of one.
            return {
                "envelope": envelope,
                "thresholds": thresholds,
                "weights": [max(1.0 - sum(weights), 0.0), *weights],
            }

        found = self.inserted(
            scene,
            0,
            values,
            form="generalized plays",
            unit=dict.fromkeys(names, 1e-3),
            positive=tuple(names),
            free=("weights", "envelope"),
            neutral=False,
        )
        return replace(found, charge=float(OPERATORS + len(envelope)))
