"""``thermal-drift``: Joule heat expands the rod."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.variant import Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation


class ThermalDrift(Effect):
    """Displacement that follows the input's square, slowly."""

    name = "thermal-drift"
    shows = "slow-time"
    place = "mechanics"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer it behind the mechanics, of one body that warms and of two.

        Two bodies in a row may change places: the second one is the quicker.
        """
        end = simulation.behind_mechanics
        small = 1e-3 * simulation.largest(end) / simulation.largest(0) ** 2
        low, high = simulation.span / 200, 3 * simulation.span
        yield self.inserted(
            simulation,
            end,
            form="one body",
            grids={"time_constant_s": logarithmic(low, high, 2.5)},
            unit={"coefficient": small},
        )
        slower = logarithmic(simulation.span / 20, high, 2.5)
        yield self.inserted(
            simulation,
            end,
            form="two bodies",
            grids={
                "time_constant_s": slower,
                "second_time_constant_s": logarithmic(low, high / 10, 2.5),
            },
            unit={"coefficient": small},
        )
