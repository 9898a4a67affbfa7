"""Block ``hysteretic-force``: a force inside a mechanism that remembers the way."""

from hystbench.blocks.force import Force
from hystbench.blocks.parameter import TINY, number


class HystereticForce(Force, name="hysteretic-force", law="hysteretic"):
    """Bouc and Wen's hysteresis, ``F = largest z``.

    ``yield_distance dz/dq = 1 - |z|^exponent (sharing + (1 - sharing) sgn(z dq))``, z
    between -1 and 1: micro-slip of joints, the fluid of a magnetorheological damper.
    With an exponent of two it yields later and more sharply. With one a sharing of zero
    is Dahl's friction; with a sharing of one it unloads along the way on which it was
    loaded. A loop that grows stiffer on loading is a ``bouc-wen-force``.
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
    exponent: float = number("-", "1 or 2", 1.0, 2.0, 1.0, whole=True)

    def numbers(self) -> tuple[float, ...]:
        """Give the stiffness, how it falls on loading and grows on unloading, and n."""
        softens = self.yield_distance**-self.exponent
        return (
            self.largest / self.yield_distance,
            softens,
            (1.0 - 2.0 * self.sharing) * softens,
            self.exponent,
        )
