"""Block ``creep``: slow displacement that follows a step."""

import numpy as np

from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.parameter import numbers
from hystbench.blocks.state_space import StateSpace


class Creep(LinearBlock, name="creep", place="mechanics"):
    """Sum of slow first-order lags beside the direct path.

    ``Y(s) = Z(s) (1 + sum_j m_j / (1 + s tau_j))``: several time constants, spread
    evenly in their logarithm, give displacement that grows with log time.

    References
    ----------
    .. [1] D. Croft, G. Shed, S. Devasia, "Creep, hysteresis, and vibration
       compensation for piezoactuators: atomic force microscopy application", Journal
       of Dynamic Systems, Measurement, and Control 123 (2001) 35-43.
    """

    magnitudes: tuple[float, ...] = numbers(
        "-", "m_j", -10.0, 10.0, as_many_as="time_constants_s"
    )
    time_constants_s: tuple[float, ...] = numbers("s", "tau_j", 1e-6, 1e6)

    def continuous(self) -> StateSpace:
        """Return one state for each time constant."""
        rates = 1.0 / np.array(self.time_constants_s)
        return StateSpace(np.diag(-rates), rates, np.array(self.magnitudes), 1.0)
