"""``hysteresis-shape``: the chain has a hysteresis, of the wrong shape."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.gap.effects.effect import Declined, Effect
from hystbench.gap.effects.variant import Variant
from hystbench.gap.simulation.simulation import Simulation


class HysteresisShape(Effect):
    """Play operators, their squares, and powers of the input beside the hysteresis.

    Its parameters are many: it is charged for all the directions that reshaping has.
    """

    name = "hysteresis-shape"
    shows = "branch"
    place = "material"
    free_forms = ("",)

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer the correction of the chain's hysteresis."""
        if simulation.hysteresis is None:
            raise Declined("the chain has no hysteresis whose shape could be wrong")
        amplitude = simulation.largest(simulation.hysteresis)
        thresholds = [amplitude * k / OPERATORS for k in range(1, OPERATORS)]
        weights = [f"weight {k}" for k in range(1, OPERATORS)]
        squares = [f"square {k}" for k in range(1, OPERATORS)]
        powers = [f"power {k}" for k in range(1, POWERS + 1)]
        size = 1e-3 * simulation.largest(simulation.behind_hysteresis)
        unit = (
            dict.fromkeys(weights, size / amplitude)
            | dict.fromkeys(squares, size / amplitude**2)
            | {name: size / amplitude**k for k, name in enumerate(powers, start=1)}
        )
        yield self.inserted(
            simulation,
            simulation.hysteresis + 1,
            lambda given: {
                "thresholds": thresholds,
                "weights": [given[name] for name in weights],
                "square_weights": [given[name] for name in squares],
                "powers": [given[name] for name in powers],
            },
            unit=unit,
            free=("weights", "square_weights", "powers"),
        )


OPERATORS = 10
POWERS = 5
