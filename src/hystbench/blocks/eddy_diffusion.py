"""Block ``eddy-diffusion``: the field diffuses into the rod against eddy currents."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np

from hystbench.blocks.linear import LinearBlock, StateSpace
from hystbench.blocks.parameter import choice, number
from hystbench.record import FloatArray

MODES = 24
"""Modes that are kept; what is left of the static gain goes to the last of them."""


@dataclass(frozen=True)
class EddyDiffusion(LinearBlock):
    """Mean field of a conductor in an alternating field.

    ``V(s) = U(s) tanh(q) / q`` for a slab, ``V(s) = U(s) 2 I1(q) / (q I0(q))`` for a
    rod, with ``q = sqrt(s tau)``. Both are sums of first-order lags
    ``c / (p_k + s tau)``: for the slab c = 2 and ``p_k = ((2k + 1) pi / 2)^2``, for the
    rod c = 4 and ``p_k`` the squared zeros of the Bessel function J0.

    References
    ----------
    .. [1] R. L. Stoll, The Analysis of Eddy Currents, Clarendon Press, 1974.
    """

    name: ClassVar = "eddy-diffusion"
    place: ClassVar = "drive"
    reference: ClassVar = "Stoll, The Analysis of Eddy Currents, 1974"

    time_constant_s: float = number("s", "tau", 1e-7, 1e3)
    geometry: str = choice("shape of the conductor", ("slab", "rod"), "slab")

    def continuous(self) -> StateSpace:
        """Return one state for each mode."""
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
