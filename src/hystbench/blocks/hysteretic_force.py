"""Block ``hysteretic-force``: a force inside a mechanism that remembers the way."""

from hystbench.blocks.force import Force
from hystbench.blocks.parameter import TINY, number


class HystereticForce(Force, name="hysteretic-force", law="hysteretic"):
    """Bouc and Wen's hysteresis of exponent one, ``F = largest z``.

    ``yield_distance dz/dq = 1 - |z| (sharing + (1 - sharing) sgn(z dq))``, z between -1
    and 1: micro-slip of joints, the fluid of a magnetorheological damper. A sharing of
    zero is Dahl's friction; with one it unloads along the way on which it was loaded.
    A loop that grows stiffer on loading is a ``bouc-wen-force``.
    Solved exactly over every monotone piece of the way.

    References
    ----------
    .. [1] Y.-K. Wen, "Method for random vibration of hysteretic systems", Journal of
       the Engineering Mechanics Division 102 (1976) 249-263.
    .. [2] F. Ikhouane, J. Rodellar, Systems with Hysteresis: Analysis, Identification
       and Control Using the Bouc-Wen Model, Wiley, 2007.
    """

    largest: float = number("U", "force at which it yields wholly", 0.0)
    yield_distance: float = number("Q", "way in which it yields", TINY)
    sharing: float = number(
        "-",
        "0: Dahl's; 0.5: unloads as stiff as at rest; 1: unloads as it loads",
        0.0,
        1.0,
        0.5,
    )

    def numbers(self) -> tuple[float, ...]:
        """Give the stiffness, and how it falls on loading and grows on unloading."""
        softens = 1.0 / self.yield_distance
        return (
            self.largest * softens,
            softens,
            (1.0 - 2.0 * self.sharing) * softens,
        )
