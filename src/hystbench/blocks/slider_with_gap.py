"""Block ``slider-with-gap``: dry friction in series with a clearance."""

from hystbench.blocks.force import Force
from hystbench.blocks.parameter import TINY, number


class SliderWithGap(Force, name="slider-with-gap", law="slider"):
    """A spring behind a clearance that slides at a force.

    ``F = contact_stiffness dead_zone(z, gap)`` with z the way, held between plus and
    minus ``gap + slip_force / contact_stiffness``. After a reversal the force falls to
    zero, is zero over the clearance, then climbs, then slides.

    References
    ----------
    .. [1] J. Awrejcewicz, C.-H. Lamarque, Bifurcation and Chaos in Nonsmooth Mechanical
       Systems, World Scientific, 2003.
    """

    contact_stiffness: float = number("U/Q", "of the contact", TINY)
    slip_force: float = number("U", "force at which it slides", 0.0)
    gap: float = number("Q", "half of the clearance", 0.0)

    def numbers(self) -> tuple[float, ...]:
        """Give the stiffness, the reach of the way and the gap."""
        reach = self.gap + self.slip_force / self.contact_stiffness
        return (self.contact_stiffness, reach, self.gap)
