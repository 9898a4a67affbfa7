"""Block ``stop``: contact inside a mechanism beyond a clearance."""

from hystbench.blocks.force import Force
from hystbench.blocks.parameter import choice, number

SIDES = {"both": 0.0, "upper": 1.0, "lower": -1.0}


class Stop(Force, name="stop", law="stop"):
    """A spring that is met where q leaves a gap.

    ``F = contact_stiffness (x - gap)^exponent``. That is for ``x = q - centre`` above
    the gap, and likewise below ``-gap`` where the stop has both sides. One that loses
    energy, as of an elastomer, takes that times ``1 + loss x'`` on the way in,
    ``1 - loss |x'|`` on the way out, never below zero.

    References
    ----------
    .. [1] S. W. Shaw, P. J. Holmes, "A periodically forced piecewise linear
       oscillator", Journal of Sound and Vibration 90 (1983) 129-155.
    .. [2] K. H. Hunt, F. R. E. Crossley, "Coefficient of restitution interpreted as
       damping in vibroimpact", Journal of Applied Mechanics 42 (1975) 440-445: with
       Hertz's exponent.
    """

    contact_stiffness: float = number(
        "U/Q", "stiffness of the contact; in U/Q^exponent", 0.0
    )
    gap: float = number("Q", "half of the clearance", 0.0)
    centre: float = number("Q", "middle of the clearance", default=0.0)
    loss: float = number(
        "s/Q", "by which a contact gives more going in", 0.0, default=0.0
    )
    exponent: float = number(
        "-",
        "power of the way into a contact: 1.5 of round bodies",
        1.0,
        10.0,
        default=1.0,
    )
    sides: str = choice("where there is contact", tuple(SIDES), "both")

    @property
    def stiffest(self) -> float:
        """That of the contact: of a curved one as far in as a tenth of the gap."""
        if self.exponent == 1.0:
            return self.contact_stiffness
        slope = self.exponent * (0.1 * self.gap) ** (self.exponent - 1.0)
        return float(self.contact_stiffness * slope)

    def numbers(self) -> tuple[float, ...]:
        """Give stiffness, gap, centre, side, loss and exponent."""
        side = SIDES[self.sides]
        return (
            self.contact_stiffness,
            self.gap,
            self.centre,
            side,
            self.loss,
            self.exponent,
        )
