"""Block ``attached-mass``: a mass behind a spring and a damper, inside a mechanism."""

from math import sqrt

import numpy as np

from hystbench.blocks.force import Force
from hystbench.blocks.parameter import TINY, number
from hystbench.record import FloatArray


class AttachedMass(Force, name="attached-mass", law="attached"):
    """A second mass, at p: ``F = mass p'' = stiffness (q - p) + damping (q - p)'``.

    A motor with a load behind a flexible shaft is a mechanism, the motor, with the load
    attached. What is driven at one place and little damped is a mass, a spring and a
    damper with such masses attached, one for each further mode [1]_: so a force inside
    acts where the device is driven, on the sum of its modes. By the midpoint rule: of
    second order, stable, and it never gives energy. It begins at rest beside the
    coordinate.

    References
    ----------
    .. [1] G. J. O'Hara, P. F. Cunniff, "Elements of Normal Mode Theory", NRL Report
       6002, 1963.
    """

    mass: float = number("U s^2/Q", "that is attached", TINY)
    damping: float = number("U s/Q", "between the two", 0.0, default=0.0)
    stiffness: float = number("U/Q", "between the two", 0.0)

    def numbers(self) -> tuple[float, ...]:
        """Give mass, damping and stiffness."""
        return (self.mass, self.damping, self.stiffness)

    def rows(self) -> FloatArray:
        """Give its row, and one of zeros: it remembers a place and a velocity."""
        own = super().rows()
        return np.vstack([own, np.zeros_like(own)])

    @property
    def stiffest(self) -> float:
        """That of the spring."""
        return self.stiffness

    @property
    def swings(self) -> float:
        """How fast it swings on a coordinate that is held."""
        return sqrt(self.stiffness / self.mass)
