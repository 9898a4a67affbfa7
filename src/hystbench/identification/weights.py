"""Weights for given envelopes: a linear problem, solved exactly."""

from dataclasses import dataclass
from typing import Literal, cast

import numpy as np
from scipy.optimize import nnls

from hystbench.envelope import Envelope
from hystbench.operators import generalized_play, generalized_prandtl_ishlinskii
from hystbench.record import FloatArray

Start = Literal["rest", "settled"]

#: Share of the largest singular value below which free weights are not resolved:
#: neighbouring operators differ so little that theirs would grow without bound.
SINGULAR = 1e-4


@dataclass(frozen=True)
class Samples:
    """Samples of a slow record, with the path of the input that led to them."""

    u: FloatArray
    y: FloatArray
    """Input and output, shape (n,) each."""
    lead: FloatArray
    """Input before the first sample, shape (m,): it sets the operators' states."""
    with_offset: bool = False
    """Whether a constant stands beside Eq. 9."""
    nonnegative: bool = True
    """Whether the weights may not be negative."""

    def outputs(self, envelope: Envelope, thresholds: FloatArray) -> FloatArray:
        """Outputs of the generalized play operators, shape (n, N + 1)."""
        path = np.concatenate([self.lead, self.u])
        values = generalized_play(envelope.left(path), envelope.right(path), thresholds)
        return values[len(self.lead) :]

    def model(
        self, envelope: Envelope, thresholds: FloatArray, weights: FloatArray
    ) -> FloatArray:
        """Output of Eq. 9, shape (n,), without the constant."""
        path = np.concatenate([self.lead, self.u])
        values = generalized_prandtl_ishlinskii(
            envelope.left(path), envelope.right(path), thresholds, weights
        )
        return values[len(self.lead) :]


def turning_points(u: FloatArray) -> FloatArray:
    """Indices where the input turns, with the first and the last one.

    A rate-independent operator remembers nothing else of the input's past.
    """
    moves = np.flatnonzero(np.diff(u)) + 1
    direction = np.sign(u[moves] - u[moves - 1])
    turns = moves[np.flatnonzero(np.diff(direction)) + 1] - 1
    return np.unique(np.concatenate([[0], turns, [len(u) - 1]]))


def lead_in(u: FloatArray, start: Start) -> FloatArray:
    """Path of the input before a record, as turning points.

    ``rest``: none; the states start at zero, Eq. 3. ``settled``: the record itself
    once over, as in a test that repeats its input.
    """
    return u[:0] if start == "rest" else u[turning_points(u)]


def reduced(u: FloatArray, y: FloatArray, count: int) -> tuple[FloatArray, FloatArray]:
    """Thin a record to about ``count`` samples, all turning points among them.

    The operators are rate independent: at the samples that stay their outputs are
    the same, to the last bit, as on the whole record.
    """
    if len(u) <= count:
        return u, y
    even = np.linspace(0, len(u) - 1, count).round().astype(int)
    keep = np.union1d(even, turning_points(u))
    return u[keep], y[keep]


def solve(
    outputs: FloatArray, y: FloatArray, with_offset: bool, nonnegative: bool = True
) -> tuple[FloatArray, float]:
    """Minimize Eq. 11 over the weights.

    The sums of products go into a triangle by Cholesky's method; the active-set
    method of Lawson and Hanson [1]_ then has the same minimum on the triangle as on
    the record. Columns are normalized first and the diagonal raised by 1e-12, since
    neighbouring operators differ little and wide ones may not move at all.

    Parameters
    ----------
    outputs : ndarray, shape (n, N + 1)
        Outputs of the operators.
    y : ndarray, shape (n,)
        Measured output.
    with_offset : bool
        Whether a constant of either sign is fitted too.
    nonnegative : bool
        Whether the weights may not be negative.

    Returns
    -------
    weights : ndarray, shape (N + 1,)
        The weights.
    offset : float
        The constant, zero if there is none.

    References
    ----------
    .. [1] C. L. Lawson and R. J. Hanson, "Solving Least Squares Problems",
       SIAM, 1995, chapter 23, doi:10.1137/1.9781611971217.
    """
    columns = np.column_stack([outputs, y])
    means = columns.mean(axis=0)
    if with_offset:  # the best constant for any weights is known: eliminate it
        largest = np.abs(columns).max(axis=0)
        columns -= means
        # an operator that never moves is a constant too: no rounding error of it
        columns[:, np.abs(columns).max(axis=0) <= 1e-12 * largest] = 0.0
    products = columns.T @ columns
    size = np.sqrt(np.diag(products))
    size[size == 0] = 1.0
    products /= np.outer(size, size)
    products += 1e-12 * np.eye(len(size))
    triangle = np.linalg.cholesky(products).T
    left, right = triangle[:, :-1], triangle[:, -1]
    if nonnegative:
        weights, _ = nnls(left, right, maxiter=100 * len(size))
    else:
        weights = np.linalg.lstsq(left, right, rcond=SINGULAR)[0]
    weights = weights * size[-1] / size[:-1]
    offset = float(means[-1] - means[:-1] @ weights) if with_offset else 0.0
    return cast(FloatArray, weights), offset
