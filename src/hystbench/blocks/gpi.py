"""Block ``gpi``: generalized Prandtl-Ishlinskii hysteresis."""

from functools import lru_cache

import numpy as np

from hystbench.blocks.attached import Others
from hystbench.blocks.parameter import a_threshold, choice, numbers
from hystbench.blocks.step import PASSED, Sampling, Step
from hystbench.blocks.wrapping import Growth, PlayBlock
from hystbench.envelope import Envelope
from hystbench.operators import (
    enveloped_plays,
    generalized_play,
    generalized_prandtl_ishlinskii,
)
from hystbench.rdgpi.model import STARTS
from hystbench.record import FloatArray


class GeneralizedPrandtlIshlinskii(PlayBlock, name="gpi", place="base"):
    """Weighted sum of generalized play operators (paper, Eqs. 3-6 and 9).

    ``y(t) = sum_i w_i F_{r_i}[z](t)`` with the envelope functions
    ``gamma_l(z) = a0 tanh(a1 z + a2) + a3`` and
    ``gamma_r(z) = a4 tanh(a5 z + a6) + a7``. Each operator starts from Eq. 3 with
    w(0) = 0, or with ``start: settled`` as the same input leaves it once it has passed:
    a loop that was repeated shows no virgin curve. Rate-independent.

    References
    ----------
    .. [1] M. Al Janaideh, S. Rakheja, C.-Y. Su, "An analytical generalized
       Prandtl-Ishlinskii model inversion for hysteresis compensation in
       micropositioning control", IEEE/ASME Transactions on Mechatronics 16 (2011)
       734-744.
    """

    envelope: tuple[float, ...] = numbers(
        "-, 1/U, -, -",
        "a0 to a7 of Eqs. 5 and 6",
        names=("a0", "a1", "a2", "a3", "a4", "a5", "a6", "a7"),
    )
    thresholds: tuple[float, ...] = numbers(
        "-", "r_i, in the unit of the envelope functions", 0.0
    )
    weights: tuple[float, ...] = a_threshold("Y", "w_i", optional=False)
    start: str = choice("operators before the first sample", STARTS, "rest")

    def grow(
        self, v: FloatArray, u: FloatArray, dt: float, growth: Growth
    ) -> FloatArray:
        """Compute Eq. 9 with all thresholds times ``growth``."""
        if growth is None and self.start == "rest":
            return enveloped_plays(v, self.envelope, self.thresholds, self.weights)
        left, right, rounds = self._envelopes(v)
        if growth is not None:
            growth = np.tile(growth, rounds)
        y = generalized_prandtl_ishlinskii(
            left, right, self.thresholds, self.weights, growth
        )
        return y[-len(v) :] if rounds > 1 else y

    def near(
        self, z: FloatArray, u: FloatArray, dt: float, others: Others
    ) -> list[FloatArray]:
        """Compute the output, and those of others with numbers near.

        Of those that differ in their weights alone the operators run once.
        """
        alike = [
            own is z
            and other.envelope == self.envelope
            and other.thresholds == self.thresholds
            and other.start == self.start
            for other, own in others
        ]
        every = [self, *(x for (x, _), one in zip(others, alike, strict=True) if one)]
        summed = iter(np.array([x.weights for x in every]) @ self.operators(z).T)
        return [
            next(summed),
            *(
                next(summed) if one else other.simulate(own, u, dt)
                for (other, own), one in zip(others, alike, strict=True)
            ),
        ]

    def operators(self, v: FloatArray) -> FloatArray:
        """Compute the outputs of the operators without their weights.

        Returns
        -------
        ndarray, shape (n, operators)
        """
        left, right, _ = self._envelopes(v)
        return generalized_play(left, right, self.thresholds)[-len(v) :]

    def _envelopes(self, v: FloatArray) -> tuple[FloatArray, FloatArray, int]:
        """Give the envelope functions of an input, and how often it passes."""
        rounds = 2 if self.start == "settled" else 1
        envelope = _envelope(*self.envelope)
        left, right = envelope.left(v), envelope.right(v)
        if rounds > 1:
            left, right = np.tile(left, rounds), np.tile(right, rounds)
        return left, right, rounds

    def step(self, sampling: Sampling) -> Step:
        """Give Eq. 9."""
        count = {"count": len(self.weights)}
        plays = self.constants("thresholds", "weights")
        constants = self.constants("envelope") | count | plays
        past = PASSED if self.start == "settled" else ""
        states = {"w": len(self.weights)}
        return Step("gpi", constants, states, grows=True, past=past)


_envelope = lru_cache(maxsize=64)(Envelope)
