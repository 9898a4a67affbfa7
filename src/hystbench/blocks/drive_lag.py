"""Block ``drive-lag``: first-order lag of amplifier and coil."""

from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.parameter import number
from hystbench.blocks.state_space import StateSpace, lag


class DriveLag(LinearBlock, name="drive-lag", place="drive"):
    """First-order lag, as of a coil's L/R: ``V(s) = U(s) / (1 + s tau)``.

    References
    ----------
    .. [1] G. Engdahl (ed.), Handbook of Giant Magnetostrictive Materials, Academic
       Press, 2000: a coil driven through its resistance.
    """

    time_constant_s: float = number("s", "tau", 1e-12, 1e3)

    def continuous(self) -> StateSpace:
        """Return the lag with its output as the state."""
        return lag(self.time_constant_s)
