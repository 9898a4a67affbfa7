"""Block ``drive-lag``: low-pass of amplifier and coil."""

from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.parameter import number
from hystbench.blocks.state_space import StateSpace, lag, mode
from hystbench.errors import InputError

LEAST = 0.05
"""Damping ratio of a filter; what rings longer is a ``resonance``."""


class DriveLag(LinearBlock, name="drive-lag", place="drive"):
    """First-order lag, as of a coil's L/R: ``V(s) = U(s) / (1 + s tau)``.

    With a damping ratio zeta it is of second order: ``V(s) = U(s) / (1 + 2 zeta s tau +
    (s tau)^2)``. Zeta is 0.71 of Butterworth's filter, 0.87 of Bessel's, and 1 of two
    equal lags.

    References
    ----------
    .. [1] G. Engdahl (ed.), Handbook of Giant Magnetostrictive Materials, Academic
       Press, 2000: a coil driven through its resistance.
    """

    time_constant_s: float = number("s", "tau", 1e-12, 1e3)
    damping_ratio: float = number(
        "-", "zeta; 0 for a lag of first order", 0.0, 10.0, default=0.0
    )

    def check(self) -> None:
        """Refuse a filter that all but rings: zero is no small damping."""
        if 0.0 < self.damping_ratio < LEAST:
            raise InputError(
                f"damping_ratio: {self.damping_ratio:g}; expected 0, for first order, "
                f"or at least {LEAST:g}"
            )

    def continuous(self) -> StateSpace:
        """Return the lag with its output, and that one's scaled rate, as states."""
        if not self.damping_ratio:
            return lag(self.time_constant_s)
        return mode(1.0 / self.time_constant_s, self.damping_ratio)
