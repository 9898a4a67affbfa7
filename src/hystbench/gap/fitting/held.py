"""What holds numbers near where they are known to be."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hystbench.record import FloatArray


class Held(NamedTuple):
    """What holds amplitudes: how far each is from its place is charged, squared."""

    stiffness: FloatArray
    """Shape (k,). Charge for the square, a tolerance's inverse square; none for what is
    not held."""
    moved: FloatArray
    """Shape (k,). How far from their places those are whose change is solved for."""

    @classmethod
    def here(cls, stiffness: FloatArray) -> Held:
        """Hold amplitudes where they are."""
        return cls(stiffness, np.zeros(len(stiffness)))

    def padded(self, count: int) -> Held:
        """Give the same for so many amplitudes, those further ones not held."""
        more = count - len(self.stiffness)
        return Held(np.pad(self.stiffness, (0, more)), np.pad(self.moved, (0, more)))

    def in_steps(self, stiffness: FloatArray) -> Held:
        """Give the same where a step from here is charged as well."""
        both = self.stiffness + stiffness
        pull = self.stiffness * self.moved
        return Held(both, np.divide(pull, both, np.zeros(len(both)), where=both > 0))

    def form(self, turned: FloatArray) -> FloatArray:
        """Give the charge as a quadratic form of (1, -b), the amplitudes being T b.

        Parameters
        ----------
        turned : ndarray, shape (k, m)
            T.

        Returns
        -------
        ndarray, shape (1 + m, 1 + m)
        """
        rows = np.column_stack([self.moved, -turned])
        return np.asarray(rows.T @ (self.stiffness[:, None] * rows))
