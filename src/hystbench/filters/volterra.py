"""Second-order Volterra adaptive filter."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hystbench import kernels
from hystbench.filters.base import AdaptiveFilter
from hystbench.filters.bound import Bound, correlation, eigenvalue_bound
from hystbench.filters.state import Chunk, End, positive
from hystbench.record import FloatArray

TILE = 4  # the kernel keeps tiles of 4 x 4 second-order weights


@dataclass(frozen=True, kw_only=True)
class VolterraFilter(AdaptiveFilter):
    """Adaptive filter of all x(k-i) and all products x(k-i) x(k-j), i, j = 0 to N.

    ``N + 1 + (N + 1)^2`` weights, first-order ones first, then the square of the
    second-order ones row by row, as the paper counts them: each product of two
    different taps has two weights. ``step_size`` is that of the first-order weights.
    Normalized, both parts are divided by the power of the whole regressor. Other
    parameters are those of :class:`hystbench.filters.base.AdaptiveFilter`.

    Parameters
    ----------
    second_order_step : float
        Convergence factor of the second-order weights.

    References
    ----------
    Diniz, Adaptive Filtering, Springer, 4th edition 2013, chapter 11.
    """

    name: ClassVar[str] = "volterra"
    label: ClassVar[str] = "Volterra filter"
    step_sizes: ClassVar[Mapping[str, str]] = {
        "first_order": "step_size",
        "second_order": "second_order_step",
    }

    second_order_step: float

    def __post_init__(self) -> None:
        """Refuse parameters out of range."""
        super().__post_init__()
        positive("second_order_step", self.second_order_step)

    @property
    def size(self) -> int:
        """Number of weights."""
        return self.taps + self.taps**2 + bool(self.constant_tap)

    @property
    def steps(self) -> FloatArray:
        """Step size of each weight."""
        sizes = (self.step_size, self.second_order_step, self.step_size)
        counts = (self.taps, self.taps**2, int(bool(self.constant_tap)))
        return np.repeat(sizes, counts)

    def regressor(
        self, line: FloatArray, operators: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Give taps and all their products at each sample."""
        x = self.windows(line)
        products = x[:, :, None] * x[:, None, :]
        return np.hstack((x, products.reshape(len(x), -1))), operators

    def bound(self, x: ArrayLike) -> Bound:
        """Bound on the step size for an input, Eq. 19, of the whole regressor.

        The two equal columns of a product make one of sqrt(2) times its size and
        one of zeros, with the same eigenvalues: so half the matrix will do. As for
        the last bits, see :meth:`hystbench.filters.base.AdaptiveFilter.bound`.
        """
        rows, columns = np.triu_indices(self.taps)
        scale = np.where(rows == columns, 1.0, np.sqrt(2.0))
        constant = [self.constant_tap] if self.constant_tap else []

        def regressors() -> Iterator[FloatArray]:
            for line in self._chunks(x):
                taps = self.windows(line)
                products = scale * taps[:, rows] * taps[:, columns]
                yield np.hstack((taps, products, np.tile(constant, (len(taps), 1))))

        return eigenvalue_bound(correlation(regressors()), self.size)

    def step_bounds(self, x: ArrayLike) -> dict[str, float]:
        """Bound on the step size of each part, 1 over the trace of its own part of R.

        At a share s of the first and 1 - s of the second the weights converge in the
        mean: with the step sizes on the diagonal of M, their mean error follows
        ``v(k+1) = (I - 2 M R) v(k)``, and no eigenvalue of ``M R`` is above its trace.

        The traces are the means of ``s(k)`` and ``s(k)^2``, where s is the sum of the
        squared taps.
        """
        before = np.full(self.taps, self.x_before)
        total = np.cumsum(np.concatenate([before, np.asarray(x)]) ** 2)
        power = total[self.taps :] - total[: -self.taps]
        first = power.mean() + self.constant_tap**2
        traces = {"first_order": first, "second_order": (power**2).mean()}
        return {name: float(1 / trace) for name, trace in traces.items()}

    def largest_power(self, x: ArrayLike) -> float:
        """Largest ``H'H`` of the taps x(k-i); that of their products is its square."""
        largest = 0.0
        for line in self._chunks(x):
            taps = self.windows(line)
            largest = max(largest, float(np.einsum("ij,ij->i", taps, taps).max()))
        return largest

    def tap_rms(self, x: ArrayLike) -> float:
        """RMS over an input of the taps x(k-i)."""
        chunks = [self.windows(line) for line in self._chunks(x)]
        total = sum(float(np.einsum("ij,ij->", taps, taps)) for taps in chunks)
        return math.sqrt(total / sum(taps.size for taps in chunks))

    def correction(self, power: float) -> float:
        """Share of an error that one update corrects, both parts together.

        Parameters
        ----------
        power : float
            Of the taps x(k-i), as :meth:`largest_power` gives it.
        """
        first = self.step_size * (power + self.constant_tap**2)
        return 2 * (first + self.second_order_step * power**2)

    def _adapt(
        self, chunk: Chunk, before: End, output: FloatArray, error: FloatArray
    ) -> tuple[int, End]:
        (line, d, limit), (weights, operators) = chunk, before
        spare = -self.taps % TILE
        parts = [self.taps, self.taps + self.taps**2]
        taps, products, constant = np.split(weights, parts)
        own = np.append(constant, 0.0)  # the kernel wants a place for its weight
        # the kernel's taps run from the oldest to the newest
        newest_last = np.concatenate((np.zeros(spare), taps[::-1]))
        first = kernels.aligned(newest_last)
        second = np.zeros((len(first), len(first)))
        second[spare:, spare:] = products.reshape(self.taps, -1)[::-1, ::-1]
        packed, unmoved = _pack(second)
        rows = line[1 + self.history - len(first) :]
        sizes = (len(d), len(first) // TILE, self.taps)
        steps = (2 * self.step_size, 2 * self.second_order_step)
        numbers = (*steps, self.constant_tap, limit)
        arrays = (first, packed, own, output, error)
        taken = kernels.call("hb_lms_volterra", *sizes, rows, d, *numbers, *arrays)
        second = (_unpack(packed, len(first)) + unmoved)[spare:, spare:]
        after = np.concatenate((first[spare:][::-1], second[::-1, ::-1].ravel(), own))
        return taken, (after[: self.size], operators)


def _tiles(matrix: FloatArray) -> FloatArray:
    """Matrix as tiles, a view: [block row, block column, row, column]."""
    blocks = len(matrix) // TILE
    return matrix.reshape(blocks, TILE, blocks, TILE).swapaxes(1, 2)


@lru_cache
def _below(blocks: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Rows and columns of the tiles on and below the diagonal, row by row."""
    return np.tril_indices(blocks)


def _pack(matrix: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Split weights into the tiles that the kernel wants and what it leaves alone.

    The kernel keeps the symmetric part, off the diagonal tiles once; the rest
    predicts nothing and never changes.
    """
    kept = 0.5 * (matrix + matrix.T)
    tiles = _tiles(kept)
    return kernels.aligned(tiles[_below(len(tiles))]), matrix - kept


def _unpack(packed: FloatArray, size: int) -> FloatArray:
    """Give the whole matrix from the tiles that the kernel keeps."""
    matrix = np.empty((size, size))
    tiles = _tiles(matrix)
    rows, columns = _below(len(tiles))
    tiles[columns, rows] = packed.swapaxes(1, 2)
    tiles[rows, columns] = packed
    return matrix
