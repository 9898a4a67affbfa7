"""Block ``logarithmic-creep``: slow displacement over decades of time."""

import numpy as np

from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.parameter import number
from hystbench.blocks.state_space import StateSpace
from hystbench.errors import InputError

ELEMENTS = 12
"""Lags that stand for all between: two a decade over six decades."""


class LogarithmicCreep(LinearBlock, name="logarithmic-creep", place="mechanics"):
    """First-order lags at all time constants between two, beside the direct path.

    ``Y(s) = Z(s) (1 + magnitude sum_j w_j / (1 + s tau_j))`` with ``ELEMENTS`` time
    constants, even in their logarithm, and weights ``w_j`` that rise as
    ``tau_j^power`` and add up to one. A step is followed by displacement that grows
    with the logarithm of time for a power of zero [1]_, and with that power of time
    for another [2]_, from the first time constant to the last.

    References
    ----------
    .. [1] H. Jung, J. Y. Shim, D. Gweon, "New open-loop actuating method of
       piezoelectric actuators for removing hysteresis and creep", Review of Scientific
       Instruments 71 (2000) 3436-3440.
    .. [2] Y. Liu, J. Shan, U. Gabbert, N. Qi, "Hysteresis and creep modeling and
       compensation for a piezoelectric actuator using a fractional-order Maxwell
       resistive capacitor approach", Smart Materials and Structures 22 (2013) 115020.
    """

    magnitude: float = number("-", "displacement in all")
    first_time_s: float = number("s", "shortest time constant", 1e-6, 1e6)
    last_time_s: float = number("s", "longest time constant", 1e-6, 1e6)
    power: float = number("-", "0 for the logarithm", -2.0, 2.0, default=0.0)

    def check(self) -> None:
        """Refuse a last time constant that is not the longer one."""
        if self.last_time_s <= self.first_time_s:
            raise InputError(
                f"last_time_s: {self.last_time_s:g}; expected more than first_time_s, "
                f"{self.first_time_s:g}"
            )

    def continuous(self) -> StateSpace:
        """Return one state for each time constant."""
        times = np.geomspace(self.first_time_s, self.last_time_s, ELEMENTS)
        weights = (times / self.last_time_s) ** self.power
        shares = self.magnitude * weights / weights.sum()
        rates = 1.0 / times
        return StateSpace(np.diag(-rates), rates, shares, 1.0)
