"""Block ``relaxation-force``: a spring in series with a damper, inside a mechanism."""

from hystbench.blocks.force import Force
from hystbench.blocks.parameter import TINY, number


class RelaxationForce(Force, name="relaxation-force", law="relaxation"):
    """Maxwell's branch: ``dF/dt = stiffness q' - F / relaxation_time_s``.

    Held at a place, the force fades; a slow motion meets a damper of ``stiffness
    relaxation_time_s``, a fast one a spring. Beside the spring of a mechanism it makes
    a standard linear solid (Zener's), several make a generalized Maxwell model. Solved
    exactly for a way that is gone evenly in each step. It begins relaxed.

    References
    ----------
    .. [1] J. D. Ferry, Viscoelastic Properties of Polymers, 3rd ed., Wiley, 1980.
    """

    stiffness: float = number("U/Q", "of the spring, met by a fast motion", 0.0)
    relaxation_time_s: float = number(
        "s", "in which the force of a place fades to 37 %", TINY
    )

    @property
    def stiffest(self) -> float:
        """That of the spring."""
        return self.stiffness
