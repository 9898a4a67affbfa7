"""Block ``gravity``: the moment of a weight inside a mechanism that turns."""

from hystbench.blocks.force import Force
from hystbench.blocks.parameter import number


class Gravity(Force, name="gravity", law="gravity"):
    """A pendulum's moment on an angle q in rad.

    ``F = amplitude (sin(q + angle) - carried sin(angle))``. The spring carries a share
    of the moment that the weight has at ``q = 0``: all of it, if q is counted from
    where the weight rests; none, if q is counted from where the spring is slack.

    References
    ----------
    .. [1] L. D. Landau, E. M. Lifshitz, Mechanics, Pergamon, 1976.
    """

    amplitude: float = number("U", "weight times its arm")
    angle: float = number("rad", "of the arm to the vertical at q = 0", -3.2, 3.2, 0.0)
    carried: float = number(
        "-", "share of its moment at q = 0 that the spring balances", 0.0, 1.0, 1.0
    )
