"""Block ``rate-dependent-hysteresis``: the loop widens with the rate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hystbench.blocks.parameter import choice, number
from hystbench.blocks.wrapping import Hysteresis, WrappingBlock
from hystbench.record import FloatArray

FORMS = ("growing-thresholds", "excess-field")


@dataclass(frozen=True)
class RateDependentHysteresis(WrappingBlock):
    """Hysteresis that depends on the rate of what enters it, v.

    With ``e = coefficient |dv/dt|^exponent``:

    - ``growing-thresholds`` [1]_: each threshold is ``r_i (1 + e)`` at each sample;
    - ``excess-field`` [2]_: the hysteresis is driven by ``v - e sign(dv/dt)``.

    The rate is a central difference, one-sided at the ends.

    References
    ----------
    .. [1] M. Al Janaideh, C.-Y. Su, S. Rakheja, "Development of the rate-dependent
       Prandtl-Ishlinskii model for smart actuators", Smart Materials and Structures
       17 (2008) 035026.
    .. [2] G. Bertotti, "General properties of power losses in soft ferromagnetic
       materials", IEEE Transactions on Magnetics 24 (1988) 621-630.
    """

    name: ClassVar = "rate-dependent-hysteresis"
    place: ClassVar = "material"
    reference: ClassVar = (
        "Al Janaideh, Su, Rakheja, Smart Mater. Struct. 17 (2008) 035026; "
        "Bertotti, IEEE Trans. Magn. 24 (1988) 621-630"
    )

    coefficient: float = number(
        "(s/U)^exponent",
        "growth at a rate of one; in U (s/U)^exponent for excess-field",
        0.0,
        1e9,
    )
    exponent: float = number("-", "power of the rate", 0.01, 10.0)
    form: str = choice("what the rate changes", FORMS, FORMS[0])

    def check_inner(self, inner: Hysteresis) -> None:
        """Refuse hysteresis without thresholds where thresholds are to grow."""
        if self.form == "growing-thresholds":
            inner.check_growth()

    def wrap(
        self,
        inner: Hysteresis,
        v: FloatArray,
        u: FloatArray,
        dt: float,
        growth: FloatArray | None = None,
    ) -> FloatArray:
        """Drive the hysteresis with larger thresholds or with less field."""
        rate = np.gradient(v, dt)
        effect = self.coefficient * np.abs(rate) ** self.exponent
        if self.form == "excess-field":
            return inner.grow(v - np.copysign(effect, rate), u, dt, growth)
        own = 1.0 + effect
        return inner.grow(v, u, dt, own if growth is None else own * growth)
