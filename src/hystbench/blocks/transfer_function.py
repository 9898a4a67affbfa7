"""Block ``transfer-function``: linear dynamics as a ratio of polynomials."""

from collections.abc import Sequence

import numpy as np

from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.parameter import numbers
from hystbench.blocks.state_space import StateSpace
from hystbench.errors import InputError


class TransferFunction(LinearBlock, name="transfer-function", place="base"):
    """Proper, stable transfer function in descending powers of s.

    ``G(s) = (n_0 s^m + ... + n_m) / (d_0 s^k + ... + d_k)`` with m <= k. One pole may
    lie at the origin (``d_k = 0``): an integrator, as between a motor's voltage and its
    position. It starts at rest.

    References
    ----------
    .. [1] T. Kailath, Linear Systems, Prentice-Hall, 1980, section 2.1 (controller
       canonical form).
    """

    numerator: tuple[float, ...] = numbers("powers of s", "n_0 to n_m, descending")
    denominator: tuple[float, ...] = numbers("powers of s", "d_0 to d_k, descending")

    @property
    def static_gain(self) -> float:
        """What an input that has stood for ever is multiplied by."""
        return self.numerator[-1] / self.denominator[-1]

    @property
    def integrates(self) -> bool:
        """Whether a pole lies at the origin."""
        return self.denominator[-1] == 0.0

    def check(self) -> None:
        """Refuse an improper or unstable transfer function."""
        if len(self.denominator) < 2 or self.denominator[0] == 0.0:
            raise InputError(
                "denominator: expected a nonzero leading coefficient and at least one "
                "more; a constant is a 'gain'"
            )
        if len(self.numerator) > len(self.denominator):
            raise InputError(
                f"numerator: degree {len(self.numerator) - 1} exceeds that of the "
                f"denominator, {len(self.denominator) - 1}; expected a proper ratio"
            )
        if self.integrates and self.start != "rest":
            raise InputError(
                f"start: {self.start!r} with a pole at s = 0, which has no state of "
                "rest under an input; expected 'rest'"
            )
        others = self.denominator[:-1] if self.integrates else self.denominator
        poles = np.roots(others)
        if np.any(poles.real >= 0.0):
            worst = poles[np.argmax(poles.real)]
            raise InputError(
                f"denominator: unstable pole at s = {worst:.6g}; "
                "expected negative real parts, or one pole at s = 0"
            )

    def continuous(self) -> StateSpace:
        """Return the controller canonical form, time scaled by the mean pole."""
        d = np.array(self.denominator) / self.denominator[0]
        order = len(d) - 1
        n = np.zeros(order + 1)
        n[order + 1 - len(self.numerator) :] = self.numerator
        n /= self.denominator[0]
        direct = float(n[0])
        # In s = scale * p the coefficients are of order one, and the matrix
        # exponential keeps its digits. Stable poles make their product positive.
        moving = d[:-1] if self.integrates else d
        scale = float(moving[-1] ** (1.0 / max(len(moving) - 1, 1)))
        powers = scale ** np.arange(order + 1)
        d, n = d / powers, n / powers
        a = np.zeros((order, order))
        a[0] = -d[1:]
        a[1:, :-1] = np.eye(order - 1)
        b = np.zeros(order)
        b[0] = scale
        return StateSpace(scale * a, b, (n - direct * d)[1:], direct)


def stable(denominator: Sequence[float]) -> tuple[float, ...]:
    """Reflect poles at the imaginary axis that lie behind it."""
    poles = np.roots(denominator)
    if np.all(poles.real < 0.0):
        return tuple(denominator)
    poles.real = -np.abs(poles.real)
    return tuple((denominator[0] * np.real(np.poly(poles))).tolist())
