"""Block ``preisach``: hysteresis as a distribution of relays."""

from functools import cached_property

import numpy as np

from hystbench import kernels
from hystbench.blocks.parameter import TINY, number, numbers
from hystbench.blocks.step import Sampling, Step
from hystbench.blocks.wrapping import HystereticBlock
from hystbench.record import FloatArray


class Preisach(HystereticBlock, name="preisach", place="material"):
    """Scalar Preisach model beside a reversible part [1]_.

    ``y = reversible z + integral of mu(a, b) R_ab[z] over b <= a``. The relay
    ``R_ab`` goes up by one where z reaches a, down by one where it reaches b. The
    density is a sum of clusters, Gaussian in the centre ``(a + b) / 2`` and in the
    half-width ``(a - b) / 2`` of the relays, within ``|a|, |b| <= limit``. It is
    constant in each cell of a grid, as in [2]_, so that the output of all relays
    follows exactly from Everett's function at the turning points. Rate-independent.

    The block starts demagnetized by alternating, falling inputs; the output counts
    from there.

    References
    ----------
    .. [1] I. D. Mayergoyz, Mathematical Models of Hysteresis, Springer, 1991,
       chapter 1.
    .. [2] X. Tan, J. S. Baras, "Modeling and control of hysteresis in magnetostrictive
       actuators", Automatica 40 (2004) 1469-1480.
    """

    limit: float = number("U", "largest input at which a relay switches", TINY)
    reversible: float = number("Y/U", "slope of the reversible part", default=0.0)
    weights: tuple[float, ...] = numbers(
        "Y", "swing of the output by each cluster of relays", 0.0
    )
    centres: tuple[float, ...] = numbers(
        "U", "mean of (a + b) / 2", as_many_as="weights"
    )
    centre_spreads: tuple[float, ...] = numbers(
        "U", "standard deviation of (a + b) / 2", TINY, as_many_as="weights"
    )
    half_widths: tuple[float, ...] = numbers(
        "U", "mean of (a - b) / 2", 0.0, as_many_as="weights"
    )
    half_width_spreads: tuple[float, ...] = numbers(
        "U", "standard deviation of (a - b) / 2", TINY, as_many_as="weights"
    )
    cells: float = number(
        "-", "cells of the grid along each axis", 2, 1000, 128.0, whole=True
    )

    @cached_property
    def cell_weights(self) -> FloatArray:
        """Weights of the relays of each cell, by the cells of a and of b.

        Returns
        -------
        ndarray, shape (cells, cells)
            Zero where b lies above a. On the diagonal it is the half of a cell in
            which it does not. They sum up to the weights.
        """
        count = int(self.cells)
        middle = self.limit * ((2 * np.arange(count) + 1) / count - 1)
        centre = (middle[:, None] + middle) / 2
        half_width = np.subtract.outer(middle, middle) / 2
        total = np.zeros((count, count))
        for weight, *cluster in zip(
            self.weights,
            self.centres,
            self.centre_spreads,
            self.half_widths,
            self.half_width_spreads,
            strict=True,
        ):
            at, spread, wide, wide_spread = cluster
            exponent = ((centre - at) / spread) ** 2
            exponent += ((half_width - wide) / wide_spread) ** 2
            exponent[half_width < 0] = np.inf
            # Counted from the nearest cell: a narrow cluster keeps its weight.
            density = np.exp(-(exponent - exponent.min()) / 2)
            density[np.diag_indices(count)] /= 2
            total += weight / density.sum() * density
        return total

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the output of all relays at each sample."""
        v = np.concatenate([self._demagnetizing(), np.ascontiguousarray(z)])
        start = len(v) - len(z)
        turns, outputs, y = np.empty(len(v) + 1), np.empty(len(v) + 1), np.empty(len(v))
        kernels.call(
            "hb_preisach",
            len(v),
            int(self.cells),
            self.limit,
            self._mass,
            v,
            turns,
            outputs,
            y,
        )
        irreversible: FloatArray = y[start:] - y[start - 1]
        return self.reversible * z + irreversible

    @cached_property
    def _mass(self) -> FloatArray:
        """Weights below each node of the grid, continued beyond the diagonal."""
        half = self.cell_weights
        mass = np.zeros(np.array(half.shape) + 1)
        mass[1:, 1:] = (half + half.T).cumsum(0).cumsum(1)
        return mass

    def _demagnetizing(self) -> FloatArray:
        """Path that alternates and falls to zero by half a cell at a time."""
        count = int(self.cells)
        size = self.limit * np.arange(count, -1, -1) / count
        path = np.repeat(size, 2)
        path[1::2] *= -1
        path[-1] = 0.0
        return np.asarray(path)

    def step(self, sampling: Sampling) -> Step:
        """Keep the turning points that are not wiped out, twice as many as at first.

        Where the input has made more of them, one inside another, the two newest go:
        their loop is the smallest of all.
        """
        cells = int(self.cells)
        room = 4 * cells + 8
        constants = {
            "cells": cells,
            "room": room,
            "limit": self.limit,
            "reversible": self.reversible,
            "mass": self._mass.ravel(),
        }
        states = {"memory": 5, "turns": room, "outputs": room}
        differs = f"keeps {room} turning points, one inside another"
        return Step("preisach", constants, states, differs=differs)
