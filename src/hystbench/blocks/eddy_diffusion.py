"""Block ``eddy-diffusion``: the field diffuses into the rod against eddy currents."""

from functools import lru_cache

import numpy as np

from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.parameter import choice, number
from hystbench.blocks.state_space import StateSpace
from hystbench.record import FloatArray

MODES = 24
"""Modes that are kept; what is left of the static gain goes to the last of them."""
HALF_SPACE = np.geomspace(1e-3, 1e6, MODES)
"""Time constants, over tau, that stand for the half-space's unbroken row of them."""


GEOMETRIES = ("slab", "rod", "half-space")


class EddyDiffusion(LinearBlock, name="eddy-diffusion", place="drive"):
    """Mean field of a conductor in an alternating field.

    ``V(s) = U(s) tanh(q) / q`` for a slab, ``V(s) = U(s) 2 I1(q) / (q I0(q))`` for a
    rod, with ``q = sqrt(s tau)`` [1]_. Both are sums of first-order lags
    ``c / (p_k + s tau)``: for the slab c = 2 and ``p_k = ((2k + 1) pi / 2)^2``, for the
    rod c = 4 and ``p_k`` the squared zeros of the Bessel function J0.

    ``V(s) = U(s) / (1 + q)`` for a half-space: a core so thick that the field never
    reaches its middle, in a magnetic circuit with a gap [2]_. Its lags ``t tau`` lie
    without a break, with the weights ``sqrt(t) / (pi (1 + t))`` in log t.

    References
    ----------
    .. [1] R. L. Stoll, The Analysis of Eddy Currents, Clarendon Press, 1974.
    .. [2] L. Zhu, C. R. Knospe, E. H. Maslen, "Analytic model for a nonlaminated
       cylindrical magnetic actuator including eddy currents", IEEE Transactions on
       Magnetics 41 (2005) 1248-1258.
    """

    time_constant_s: float = number("s", "tau", 1e-12, 1e3)
    geometry: str = choice("shape of the conductor", GEOMETRIES, GEOMETRIES[0])

    def continuous(self) -> StateSpace:
        """Return one state for each mode."""
        if self.geometry == "half-space":
            apart = np.log(HALF_SPACE[1] / HALF_SPACE[0])
            shares = apart / np.pi * np.sqrt(HALF_SPACE) / (1 + HALF_SPACE)
            shares[0] += 1 - shares.sum()  # what is quicker still
            rates = 1 / (HALF_SPACE * self.time_constant_s)
            return StateSpace(np.diag(-rates), rates, shares, 0.0)
        if self.geometry == "slab":
            poles = ((2 * np.arange(MODES) + 1) * np.pi / 2) ** 2
            shares = 2 / poles
        else:
            poles = _zeros() ** 2
            shares = 4 / poles
        shares[-1] += 1 - shares.sum()
        rates = poles / self.time_constant_s
        return StateSpace(np.diag(-rates), rates, shares, 0.0)


@lru_cache(maxsize=1)
def _zeros() -> FloatArray:
    """Give the first zeros of the Bessel function J0."""
    from scipy.special import jn_zeros  # late: a filter never needs it

    zeros: FloatArray = jn_zeros(0, MODES)
    return zeros
