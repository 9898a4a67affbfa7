"""Block ``gain``: a static straight line."""

from __future__ import annotations

from hystbench.blocks.base import PolynomialBlock
from hystbench.blocks.parameter import HUGE, number


class Gain(PolynomialBlock, name="gain", place="base"):
    """Static gain with an offset: ``y = value z + offset``.

    References
    ----------
    By definition.
    """

    value: float = number("Y/U", "static gain", -HUGE, HUGE)
    offset: float = number("Y", "output at zero", -HUGE, HUGE, default=0.0)

    @property
    def coefficients(self) -> tuple[float, ...]:
        """Those of the polynomial, the constant first."""
        return self.offset, self.value
