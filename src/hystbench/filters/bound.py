"""Bound on the step size of an adaptive filter, Eq. 19."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from hystbench.record import FloatArray

MOST_CORRECTION = 1.7
"""Most that one update may correct of an error where a margin is asked for.

Beyond 2 the LMS of Eq. 18 is unstable while its regressor moves little; see
:meth:`hystbench.filters.base.AdaptiveFilter.correction`. Errors at that edge are those
of an incipient instability. 1.7 leaves 15 %.
"""


@dataclass(frozen=True)
class Bound:
    """Bound on the step size, Eq. 19, and what sets the speed of convergence."""

    trace: float
    """Trace of ``R = E[H H']``, the mean over the record."""
    largest: float
    smallest: float
    """Eigenvalues of R; the smallest is zero where R has less than full rank."""
    rank: int
    """Eigenvalues above ``size * eps * largest``: the others are rounding."""
    size: int
    """Number of weights."""
    smallest_nonzero: float
    """Smallest eigenvalue that counts for the rank."""

    @property
    def bound(self) -> float:
        """Step sizes between zero and this converge in the mean: 1 / trace."""
        return 1 / self.trace if self.trace > 0 else np.inf

    @property
    def spread(self) -> float:
        """Largest over smallest eigenvalue; infinite where R has not full rank."""
        return self.largest / self.smallest if self.smallest > 0 else np.inf

    @property
    def spread_nonzero(self) -> float:
        """Largest over smallest of the eigenvalues that are not rounding."""
        return self.largest / self.smallest_nonzero if self.rank else np.inf


def correlation(regressors: Iterable[FloatArray]) -> FloatArray:
    """Mean of H H' over regressors, some samples of them at a time."""
    total, count = np.zeros(()), 0
    for rows in regressors:
        total = total + rows.T @ rows
        count += len(rows)
    return total / count


def eigenvalue_bound(correlation: FloatArray, size: int) -> Bound:
    """Eigenvalues of R; those beyond the matrix given, up to ``size``, are zero.

    They are LAPACK's: their last bits may depend on the number of its threads.
    """
    values = np.linalg.eigvalsh(correlation)
    largest = float(values[-1])
    nonzero = values[values > size * np.finfo(float).eps * largest]
    rank = len(nonzero)
    smallest = float(nonzero[0]) if rank else 0.0
    return Bound(
        trace=float(np.trace(correlation)),
        largest=largest,
        smallest=smallest if rank == size else 0.0,
        rank=rank,
        size=size,
        smallest_nonzero=smallest,
    )
