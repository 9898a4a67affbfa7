"""Block ``velocity-limit``: inside a mechanism, what lets it move no faster."""

from hystbench.blocks.force import Force
from hystbench.blocks.parameter import TINY, number


class VelocityLimit(Force, name="velocity-limit", law="faster"):
    """A damper that acts beyond a velocity, ``F = damping (q' - rate sgn q')`` there.

    A pump that gives no more oil, a motor at its largest speed. With a large damping it
    is the rate limit of a servo: ``time_constant q' = z - q`` within ``|q'| <= rate``.

    References
    ----------
    .. [1] H. E. Merritt, Hydraulic Control Systems, Wiley, 1967: limits of a servo.
    """

    rate: float = number("Q/s", "largest velocity without this force", TINY)
    damping: float = number("U s/Q", "of the damper beyond it", 0.0)
