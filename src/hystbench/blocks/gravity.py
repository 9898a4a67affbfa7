"""Block ``gravity``: the moment of a weight inside a mechanism that turns."""

import math

from hystbench.blocks.force import Force
from hystbench.blocks.parameter import choice, number

RADIANS = {"rad": 1.0, "deg": math.pi / 180}
"""Radians in a unit of q."""


class Gravity(Force, name="gravity", law="gravity"):
    """A pendulum's moment on an angle q.

    ``F = amplitude (sin(q + angle) - carried sin(angle) - straight q cos(angle))``, q
    in rad; where the coordinate is in degrees, ``unit: deg`` says so. The spring
    carries a share of the moment that the weight has at ``q = 0``: all of it, if q is
    counted from where the weight rests; none, if q is counted from where the spring is
    slack. Where the model of a pendulum was linearized, its spring has the slope of
    that moment as well: then ``straight`` is one.

    References
    ----------
    .. [1] L. D. Landau, E. M. Lifshitz, Mechanics, Pergamon, 1976.
    """

    amplitude: float = number("U", "weight times its arm")
    angle: float = number("rad", "of the arm to the vertical at q = 0", -3.2, 3.2, 0.0)
    carried: float = number(
        "-", "share of its moment at q = 0 that the spring balances", 0.0, 1.0, 1.0
    )
    straight: float = number(
        "-", "share of its slope at q = 0 that the spring has", 0.0, 1.0, 0.0
    )
    unit: str = choice("of the coordinate", tuple(RADIANS), "rad")

    def numbers(self) -> tuple[float, ...]:
        """Give the numbers of the law: a unit of q in rad, and a slope, come last."""
        slope = self.straight * math.cos(self.angle)
        turns = RADIANS[self.unit]
        return (self.amplitude, self.angle, self.carried, turns, slope)

    @property
    def slope(self) -> float:
        """A pendulum swings as fast as this says."""
        steep = (1.0 - self.straight) * math.cos(self.angle)
        return self.amplitude * RADIANS[self.unit] * steep
