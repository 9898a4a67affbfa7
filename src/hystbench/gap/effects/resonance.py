"""``resonance``: a mechanical mode."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hystbench.gap.effects.base import Effect, Variant, logarithmic
from hystbench.gap.scene import Scene


class Resonance(Effect):
    """A mode behind the hysteresis, of less than a third of critical damping.

    A heavily damped fast mode is a lag or a delay to the data: it may not take their
    place.
    """

    name = "resonance"
    place = "mechanics"

    def variants(self, scene: Scene) -> Iterator[Variant]:
        """Offer modes from two periods in the shortest record to 0.45 of the rate."""
        low, high = 2 / scene.shortest, 0.45 / scene.step
        yield self.inserted(
            scene,
            scene.behind_material,
            grids={
                "frequency_hz": logarithmic(low, high, 6),
                "damping_ratio": np.array([0.01, 0.15]),
            },
            unit={"participation": 0.01},
            inside=("frequency_hz", "damping_ratio"),
            limits={"damping_ratio": (0.001, 0.33)},
        )
