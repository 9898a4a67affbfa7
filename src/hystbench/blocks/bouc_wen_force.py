"""Block ``bouc-wen-force``: Bouc and Wen's hysteresis, which may grow stiffer."""

from hystbench.blocks.force import Force
from hystbench.blocks.parameter import number


class BoucWenForce(Force, name="bouc-wen-force", law="hysteretic"):
    """Bouc and Wen's hysteresis of exponent one, by Wen's numbers.

    ``dF/dq = stiffness - |F| (beta sgn(F dq) + gamma)``. On loading the stiffness falls
    by ``beta + gamma`` for each unit of force, or grows where that is negative; on
    unloading it grows by ``beta - gamma``. Where the sum is positive the force never
    exceeds ``stiffness / (beta + gamma)`` and ``hysteretic-force`` is the same law;
    where it is negative, the force grows with the exponential of the reach of the
    motion.

    With a beta of zero or more, which is asked for, the force is passive: from a force
    F no more than ``integral of f / (stiffness + (beta - gamma) f)`` from zero to
    ``|F|`` is got back, which is the work of unloading, and loading takes at least as
    much. With a beta of zero it is an elastic spring. Ikhouane and Rodellar ask besides
    that ``beta + gamma > 0``, for a force that is bounded whatever the motion is.
    Solved exactly over every monotone piece of the way.

    References
    ----------
    .. [1] Y.-K. Wen, "Method for random vibration of hysteretic systems", Journal of
       the Engineering Mechanics Division 102 (1976) 249-263.
    .. [2] F. Ikhouane, J. Rodellar, Systems with Hysteresis: Analysis, Identification
       and Control Using the Bouc-Wen Model, Wiley, 2007.
    .. [3] S. Erlicher, N. Point, "Thermodynamic admissibility of Bouc-Wen type
       hysteresis models", Comptes Rendus Mecanique 332 (2004) 51-57.
    """

    stiffness: float = number("U/Q", "where the force is zero", 0.0)
    beta: float = number(
        "1/Q", "half of (unloading - loading stiffness), per force", 0.0
    )
    gamma: float = number(
        "1/Q", "lowers both stiffnesses, per force; raises them where negative"
    )

    @property
    def stiffest(self) -> float:
        """Four times that at rest: steps of half the length that a spring asks for.

        Its work is exact over a step, but its motion is not, as that of the linear
        spring is, and on unloading it is stiffer than at rest.
        """
        return 4.0 * self.stiffness

    def numbers(self) -> tuple[float, ...]:
        """Give the stiffness, and how it falls on loading and grows on unloading."""
        return (
            self.stiffness,
            self.beta + self.gamma,
            self.beta - self.gamma,
        )
