"""Block ``smooth-friction``: friction inside a mechanism that a fluid makes smooth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hystbench.blocks.force import Force
from hystbench.blocks.parameter import HUGE, TINY, number


@dataclass(frozen=True)
class SmoothFriction(Force):
    """Coulomb friction that grows with the velocity, ``F = coulomb tanh(q' / scale)``.

    A lubricated or magnetorheological fluid yields like that. It creeps at rest, where
    ``friction-force`` holds.

    References
    ----------
    .. [1] B. F. Spencer, S. J. Dyke, M. K. Sain, J. D. Carlson, "Phenomenological model
       for magnetorheological dampers", Journal of Engineering Mechanics 123 (1997)
       230-238.
    """

    name: ClassVar = "smooth-friction"

    coulomb: float = number("U", "force at high velocity", 0.0, HUGE)
    velocity_scale: float = number(
        "Q/s", "velocity at which 76 % of it are there", TINY, HUGE
    )

    def law(self) -> tuple[str, tuple[float, ...]]:
        """Give the force and the velocity."""
        return "smooth", (self.coulomb, self.velocity_scale)
