"""Block ``smooth-friction``: friction inside a mechanism that a fluid makes smooth."""

from hystbench.blocks.force import Force
from hystbench.blocks.parameter import TINY, number


class SmoothFriction(Force, name="smooth-friction", law="smooth"):
    """Friction that grows with the velocity, ``F = level tanh(q' / velocity_scale)``.

    A lubricated or magnetorheological fluid yields like that. It creeps at rest, where
    ``friction-force`` holds. The level is ``coulomb + static_excess
    exp(-(q' / stribeck_velocity)^2)`` (Stribeck's curve); with a Stribeck velocity of
    zero there is no excess.

    References
    ----------
    .. [1] B. F. Spencer, S. J. Dyke, M. K. Sain, J. D. Carlson, "Phenomenological model
       for magnetorheological dampers", Journal of Engineering Mechanics 123 (1997)
       230-238.
    .. [2] B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, "A survey of models,
       analysis tools and compensation methods for the control of machines with
       friction", Automatica 30 (1994) 1083-1138.
    """

    coulomb: float = number("U", "force at high velocity", 0.0)
    velocity_scale: float = number(
        "Q/s", "velocity at which 76 % of it are there", TINY
    )
    static_excess: float = number(
        "U", "by how much the force near rest exceeds it", 0.0, default=0.0
    )
    stribeck_velocity: float = number(
        "Q/s", "velocity at which the excess has faded", 0.0, default=0.0
    )
