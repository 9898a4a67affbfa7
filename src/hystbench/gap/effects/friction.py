"""``friction``: a force that opposes the direction of motion."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.blocks.friction_force import FrictionForce
from hystbench.blocks.hysteretic_force import HystereticForce
from hystbench.blocks.lugre_force import LuGreForce
from hystbench.blocks.smooth_friction import SmoothFriction
from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.law import Law, Moved
from hystbench.gap.effects.variant import Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation
from hystbench.gap.thresholds import SLIDES

HOLDS = 1e-7
"""Share of the reach by which dry friction gives way where it holds: no record shows
so little."""
SOON = 1e-3
"""The same where it gives way along a curve."""
BENDS = 0.1
"""The same, at most, where it falls with the velocity, as no hysteretic force does:
there is friction that slides on most of its way."""
VISCOUS = 1.0
"""Of the fastest velocity: there the tangent is a quarter below a straight line. What
bends less is as much as viscous."""


class Friction(Effect):
    """Dry friction: smooth behind the mechanics, by several laws inside."""

    name = "friction"
    shows = "branch"
    place = "mechanics"
    laws = ("friction-force", "lugre-force", "smooth-friction", "hysteretic-force")

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer it behind the mechanics, by the velocity at which it saturates."""
        end = simulation.behind_mechanics
        fastest = simulation.fastest()
        yield self.inserted(
            simulation,
            end,
            grids={"velocity_scale": logarithmic(1e-4 * fastest, fastest / 5, 2)},
            # A seal's friction may bend as late as that; beyond it is viscous.
            limits={"velocity_scale": (1e-4 * fastest, VISCOUS * fastest)},
            refused={"velocity_scale": "either"},
            unit={"coulomb": 1e-3 * simulation.largest(end)},
        )

    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Offer dry friction that holds, or gives way before it slides."""
        for share in (0.03, 0.3):
            dry = FrictionForce(
                coulomb=share * moved.force, presliding_distance=HOLDS * moved.reach
            )
            yield Law("dry", dry, ("coulomb",))
        # A fit from a long way finds others as long, and hardly a short one.
        for share, way in ((0.03, 1e-3), (0.1, 3e-2)):
            own = {
                "coulomb": share * moved.force,
                "presliding_distance": way * moved.reach,
            }
            yield Law("Coulomb", FrictionForce(**own), tuple(own))
            own |= {
                "static_excess": 0.5 * share * moved.force,
                "stribeck_velocity": 0.1 * moved.speed,
            }
            yield Law("Stribeck", FrictionForce(**own), tuple(own))
            ranges = {"presliding_distance": (0.0, BENDS * moved.reach)}
            yield Law("LuGre", LuGreForce(**own), tuple(own), ranges=ranges)
        for share in (0.03, 0.3):
            dahl = {
                "largest": share * moved.force,
                "yield_distance": SOON * moved.reach,
            }
            block = HystereticForce(**dahl, sharing=0.0)
            ranges = {"yield_distance": (0.0, SLIDES * moved.reach)}
            yield Law("Dahl", block, tuple(dahl), ranges=ranges)
        for share in (0.03, 0.3):
            smooth = {
                "coulomb": 0.1 * moved.force,
                "velocity_scale": share * moved.speed,
            }
            yield Law("smooth", SmoothFriction(**smooth), tuple(smooth))
        # It hardly grows near rest: a motion that stands is then not held.
        for share, fades in ((1e-3, 0.03), (1e-2, 0.1)):
            own = {
                "coulomb": 0.1 * moved.force,
                "velocity_scale": share * moved.speed,
                "static_excess": 0.05 * moved.force,
                "stribeck_velocity": fades * moved.speed,
            }
            yield Law("smooth Stribeck", SmoothFriction(**own), tuple(own))
