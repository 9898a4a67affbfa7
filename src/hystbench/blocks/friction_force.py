"""Block ``friction-force``: dry friction inside a mechanism."""

from hystbench.blocks.force import Force
from hystbench.blocks.parameter import TINY, number


class FrictionForce(Force, name="friction-force", law="friction"):
    """Coulomb friction that gives way by a small distance before it slides.

    ``F = (coulomb + static_excess) z / presliding_distance`` with z the way, held where
    F is ``coulomb + static_excess exp(-(q' / stribeck_velocity)^2)`` either way (a stop
    operator): so it holds where the device rests. With a Stribeck velocity of zero
    there is no excess.

    References
    ----------
    .. [1] B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, "A survey of models,
       analysis tools and compensation methods for the control of machines with
       friction", Automatica 30 (1994) 1083-1138.
    .. [2] F. Al-Bender, V. Lampaert, J. Swevers, "The generalized Maxwell-slip model",
       IEEE Transactions on Automatic Control 50 (2005) 1883-1887.
    """

    coulomb: float = number("U", "force of sliding", 0.0)
    presliding_distance: float = number("Q", "way from rest to sliding", TINY)
    static_excess: float = number(
        "U", "by how much the force near rest exceeds it", 0.0, default=0.0
    )
    stribeck_velocity: float = number(
        "Q/s", "velocity at which the static force has faded", 0.0, default=0.0
    )

    def numbers(self) -> tuple[float, ...]:
        """Give both forces, the velocity and the distance."""
        return (
            self.coulomb,
            self.static_excess,
            self.stribeck_velocity,
            self.presliding_distance,
        )
