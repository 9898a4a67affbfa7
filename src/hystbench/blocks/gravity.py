"""Block ``gravity``: the moment of a weight inside a mechanism that turns."""

from hystbench.blocks.force import Force
from hystbench.blocks.parameter import HUGE, number


class Gravity(Force, name="gravity", law="gravity"):
    """A pendulum's moment, ``F = amplitude (sin(q + angle) - sin(angle))``, q in rad.

    References
    ----------
    .. [1] L. D. Landau, E. M. Lifshitz, Mechanics, Pergamon, 1976.
    """

    amplitude: float = number("U", "weight times its arm", -HUGE, HUGE)
    angle: float = number("rad", "of the arm to the vertical at q = 0", -3.2, 3.2, 0.0)
