"""Forces inside a mechanism, and friction and play behind the mechanics."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.bouc_wen_force import BoucWenForce
from hystbench.blocks.drag import Drag as DragBlock
from hystbench.blocks.friction_force import FrictionForce
from hystbench.blocks.gravity import RADIANS
from hystbench.blocks.gravity import Gravity as GravityBlock
from hystbench.blocks.hysteretic_force import HystereticForce as BoucWen
from hystbench.blocks.iwan_force import LEAST_EXPONENT, IwanForce
from hystbench.blocks.lugre_force import LuGreForce
from hystbench.blocks.resonance import Resonance
from hystbench.blocks.smooth_friction import SmoothFriction
from hystbench.gap.effects.effect import Effect, InsideEffect
from hystbench.gap.effects.law import Law, Moved, Passed
from hystbench.gap.effects.places import has_dynamics
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
ENDLESS = 1e4
"""Times its scale of velocity at which a tangent is a straight line."""
VISCOUS = 1.0
"""Largest scale of velocity, as a share of the fastest velocity: there the tangent is a
quarter below a straight line. What bends less is as much as viscous."""


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
            block = BoucWen(**dahl, sharing=0.0)
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

    def other_laws(self, block: Any) -> Iterator[Law]:
        """One without Stribeck's excess, as large as it is near rest."""
        if not getattr(block, "static_excess", 0.0):
            return
        largest = block.coulomb + block.static_excess
        if isinstance(block, SmoothFriction):
            own = {"coulomb": largest, "velocity_scale": block.velocity_scale}
            yield Law("smooth", SmoothFriction(**own), tuple(own))
        else:
            own = {
                "coulomb": largest,
                "presliding_distance": block.presliding_distance,
            }
            yield Law("Coulomb", FrictionForce(**own), tuple(own))

    def vanishing(self, form: str, block: Any) -> Iterator[tuple[Block, str]]:
        """One that grows with the velocity without an end is a linear damper."""
        if isinstance(block, SmoothFriction) and block.stribeck_velocity == 0.0:
            line = replace(
                block,
                coulomb=ENDLESS * block.coulomb,
                velocity_scale=ENDLESS * block.velocity_scale,
            )
            yield line, "velocity_scale"


class Backlash(Effect):
    """A play operator behind the mechanics, or before what has no hysteresis.

    Also before a mode: as of a gear, behind which the load swings.
    """

    name = "backlash"
    shows = "branch"
    place = "mechanics"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer half-widths up to a third of the largest output, or input."""
        end = simulation.behind_mechanics
        places = {end: ""}
        if simulation.loop is None and has_dynamics(simulation):
            chain = simulation.chain[:end]
            modes = (k for k, x in enumerate(chain) if isinstance(x, Resonance))
            places |= dict.fromkeys(modes, "before the load's mode") | {0: "before"}
        for place, form in places.items():
            largest = simulation.largest(place)
            grid = logarithmic(3e-4 * largest, largest / 3, 4)
            yield self.inserted(
                simulation, place, form=form, grids={"half_width": grid}
            )

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer narrow and wide play behind the host, and wide play before it."""
        for share in (0.01, 0.1):
            yield self.curve("behind", half_width=share * passed.shown)
        yield self.curve("before", half_width=0.1 * passed.given)


class Drag(InsideEffect):
    """Drag of a fluid in turbulent flow."""

    name = "drag"
    shows = "rate"

    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Offer it weak, and so strong that it takes a third of the drive."""
        for share in (0.03, 0.3):
            block = DragBlock(coefficient=share * moved.force / moved.speed**2)
            yield Law("", block, ("coefficient",))


BESIDE = 2.0
"""Weight in times of a known spring, as of an arm that was measured lying: a weight
above the spring is far from any share of it."""


class Gravity(InsideEffect):
    """The weight of a pendulum, by the sine of its angle."""

    name = "gravity"
    shows = "amplitude"
    special = True
    taken_from = "stiffness"

    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Offer a weight that makes half of the spring, one against it, one beside it.

        The coordinate is an angle. It is counted from the vertical, or from any angle:
        from where the weight is at rest, or from where the spring is. Without a spring
        the weight alone holds it. A known spring may have its straight line already.
        """
        both = ("amplitude", "angle")
        if not moved.turns or moved.anywhere:
            return
        if moved.loose:
            spring = moved.stiffness / RADIANS[moved.turns]
            alone = GravityBlock(amplitude=spring, unit=moved.turns)
            yield Law("without a spring", alone, both[:1], stands_for=1.0)
        if moved.stiffness == 0.0:
            arm = GravityBlock(amplitude=0.3 * moved.force, unit=moved.turns)
            yield Law("", arm, both[:1])
            yield Law("tilted", arm, both)
            return
        for share in (BESIDE, 0.5, -0.5):
            # Of so small an angle that its sine is the angle, a spring.
            weight = share * moved.stiffness / RADIANS[moved.turns]
            block = GravityBlock(amplitude=weight, unit=moved.turns)
            part = share if share < 1 else 0.0
            yield Law("", block, both[:1], stands_for=part)
            yield Law("tilted", block, both, stands_for=part)
            slack = replace(block, carried=0.0)
            yield Law("tilted, from a slack spring", slack, both, stands_for=part)
        if moved.known and moved.stiffness > 0.0:
            weight = 0.5 * moved.stiffness / RADIANS[moved.turns]
            block = GravityBlock(amplitude=weight, straight=1.0, unit=moved.turns)
            yield Law("linearized before", block, both[:1])
            yield Law("linearized before, tilted", block, both)


STEEPEST = 1.0
"""Exponent of plays, at most. Of a joint it is below zero (Segalman); a large one makes
one way at which all slip, which is dry friction that gives way."""
EVEN_FORCE = -2.0
"""Exponent at which every decade of thresholds holds as much force. Below it most of
the force gives way with the first slip, however long the slip distance is."""
LATEST = 0.5
"""Share of the slip distance at which the first plays slip, at most: with one that is
as late as the last all slip at once, too."""


BOUC_WEN = {1.0: "Bouc-Wen", 2.0: "Bouc-Wen, exponent 2"}
"""Its laws, by the exponent."""


class HystereticForce(InsideEffect):
    """Bouc and Wen's hysteresis as a force, or plays."""

    name = "hysteretic-force"
    shows = "branch"
    laws = ("bouc-wen-force", "iwan-force")

    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Offer it weak, with short and long ways to yield, or as one that stiffens."""
        names = ("largest", "yield_distance", "sharing")
        for share, way in ((0.03, 0.03), (0.1, 0.3), (0.3, 1.0)):
            block = BoucWen(
                largest=share * moved.force, yield_distance=way * moved.reach
            )
            ranges = {"yield_distance": (SLIDES * moved.reach, np.inf)}
            yield Law(BOUC_WEN[1.0], block, names, ranges=ranges)
            sharper = replace(block, exponent=2.0)
            yield Law(BOUC_WEN[2.0], sharper, names, ranges=ranges)
        # Beyond such a beta it would slide on nearly all of its way.
        stiffness = max(moved.stiffness, moved.force / moved.reach)
        stiffens = {
            "beta": (0.0, 1.0 / (SLIDES * moved.reach)),
            "gamma": (-np.inf, 0.0),
        }
        for share, softer, stiffer in ((0.1, 0.3, 0.3), (0.3, 1.0, 1.5)):
            wen = {
                "stiffness": share * stiffness,
                "beta": softer / moved.reach,
                "gamma": -stiffer / moved.reach,
            }
            yield Law(
                "Bouc-Wen, stiffer on loading",
                BoucWenForce(**wen),
                tuple(wen),
                ranges=stiffens,
            )
        plays = ("stiffness", "slip_distance", "exponent")
        for share, way in ((0.1, 0.3), (0.3, 1.0)):
            iwan = IwanForce(
                stiffness=share * stiffness, slip_distance=way * moved.reach
            )
            ranges = {
                "slip_distance": (SLIDES * moved.reach, np.inf),
                "exponent": (LEAST_EXPONENT, STEEPEST),
            }
            yield Law("plays", iwan, plays, ranges=ranges)
        late = IwanForce(
            stiffness=0.3 * stiffness,
            slip_distance=0.5 * moved.reach,
            exponent=-1.0,
            first_slip=0.1,
        )
        yield Law(
            "plays from a first slip on",
            late,
            (*plays, "first_slip"),
            ranges={
                "slip_distance": (SLIDES * moved.reach, np.inf),
                "exponent": (EVEN_FORCE, STEEPEST),
                "first_slip": (0.0, LATEST),
            },
        )

    def other_laws(self, block: Any) -> Iterator[Law]:
        """That of the other exponent."""
        if isinstance(block, BoucWen):
            exponent = 1.0 if block.exponent == 2.0 else 2.0
            names = ("largest", "yield_distance", "sharing")
            yield Law(BOUC_WEN[exponent], replace(block, exponent=exponent), names)

    def vanishing(self, form: str, block: Any) -> Iterator[tuple[Block, str]]:
        """Without a loop it is a spring."""
        for name, value in (("beta", 0.0), ("sharing", 1.0)):
            if name in block.parameters():
                yield replace(block, **{name: value}), name
