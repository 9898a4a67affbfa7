"""Block ``lugre-force``: friction of bristles that bend, inside a mechanism."""

from hystbench.blocks.friction_force import FrictionForce


class LuGreForce(FrictionForce, name="lugre-force", law="lugre"):
    """Friction that nears its force of sliding along a curve, and falls with velocity.

    ``F = (coulomb + static_excess) z / presliding_distance`` with z the mean bend of
    bristles, ``dz/dt = q' - abs(q') z / g(q')``. It slides at ``g(q')``, where F is
    ``coulomb + static_excess exp(-(q' / stribeck_velocity)^2)``: LuGre's model without
    the damping of the bristles, which is Dahl's where nothing falls with velocity.
    Solved exactly for a way that is gone evenly in each step.

    References
    ----------
    .. [1] C. Canudas de Wit, H. Olsson, K. J. Astrom, P. Lischinsky, "A new model for
       control of systems with friction", IEEE Transactions on Automatic Control 40
       (1995) 419-425.
    """
