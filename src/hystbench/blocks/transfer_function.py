"""Block ``transfer-function``: linear dynamics as a ratio of polynomials."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Literal

import numpy as np

from hystbench.blocks.base import Place
from hystbench.blocks.linear import LinearBlock, linear_step
from hystbench.blocks.parameter import HUGE, choice, numbers
from hystbench.blocks.state_space import StateSpace
from hystbench.blocks.step import REPEATED, TURNED, Sampling, Step
from hystbench.errors import InputError
from hystbench.record import FloatArray, Record

Start = Literal["rest", "settled", "moving", "repeating"]
STARTS: tuple[Start, ...] = ("rest", "settled", "moving", "repeating")
CLEARLY = 1.01
"""The plainest start is taken whose squares of errors are within this factor of the
best."""
PASTS = {"moving": TURNED, "repeating": REPEATED}
"""Starts that depend on samples to come, and what came before."""


@dataclass(frozen=True)
class TransferFunction(LinearBlock):
    """Proper, stable transfer function in descending powers of s.

    ``G(s) = (n_0 s^m + ... + n_m) / (d_0 s^k + ... + d_k)`` with m <= k. With
    ``start: settled`` the input had its first value for ever before the record. With
    ``moving`` it came through the first sample as it leaves it, the record turned about
    that sample: one that begins in the middle of a motion shows neither jump nor kink.
    With ``repeating`` the same record came before, as whole periods of an input do.

    References
    ----------
    .. [1] T. Kailath, Linear Systems, Prentice-Hall, 1980, section 2.1 (controller
       canonical form).
    """

    name: ClassVar = "transfer-function"
    place: ClassVar[Place] = "base"

    numerator: tuple[float, ...] = numbers(
        "powers of s", "n_0 to n_m, descending", -HUGE, HUGE
    )
    denominator: tuple[float, ...] = numbers(
        "powers of s", "d_0 to d_k, descending", -HUGE, HUGE
    )
    start: str = choice("state before the first sample", STARTS, "rest")

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the response to ``z``."""
        path, before = path_from(z, self.start)
        static = self.numerator[-1] / self.denominator[-1]
        y = super().simulate(path - before, u, dt) + static * before
        return y[len(path) - len(z) :]

    def step(self, sampling: Sampling) -> Step:
        """Move the state."""
        settled = self.start != "rest"
        step = linear_step(self.continuous(), sampling, self.holding, settled)
        return replace(step, past=PASTS.get(self.start, ""))

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
        poles = np.roots(self.denominator)
        if np.any(poles.real >= 0.0):
            worst = poles[np.argmax(poles.real)]
            raise InputError(
                f"denominator: unstable pole at s = {worst:.6g}; "
                "expected negative real parts"
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
        # exponential keeps its digits. Stable poles make d[-1] positive.
        scale = float(d[-1] ** (1.0 / order))
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


def possible_starts(records: Sequence[Record]) -> tuple[Start, ...]:
    """Give the starts that records may have: only whole periods repeat."""
    return STARTS if all(record.repeats for record in records) else STARTS[:-1]


def plainest_start(costs: Sequence[float]) -> int:
    """Choose among possible starts, the plainest first, by what each leaves.

    Parameters
    ----------
    costs : sequence of float
        Squares of the errors, in the order of :func:`possible_starts`.

    Returns
    -------
    int
        Place of the first that is as good as the best, to a hundredth.
    """
    most = CLEARLY * min(costs)
    return next(k for k, cost in enumerate(costs) if cost <= most)


def path_from(z: FloatArray, start: str) -> tuple[FloatArray, float]:
    """Put before a record what its start stands for.

    Parameters
    ----------
    z : ndarray, shape (n,)
    start : {"rest", "settled", "moving", "repeating"}

    Returns
    -------
    path : ndarray, shape (n,), (2n - 1,) or (2n,)
        What was before, and ``z``.
    before : float
        What was for ever before that.
    """
    if start == "rest" or len(z) == 0:
        return z, 0.0
    if start == "moving":
        z = np.concatenate([2 * z[0] - z[:0:-1], z])
    elif start == "repeating":
        z = np.concatenate([z, z])
    return z, float(z[0])
