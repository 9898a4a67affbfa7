"""Least squares with a prior variance for each group of columns, found by evidence.

A signal is a sum of columns and white noise. The amplitudes of a group of columns are
normal about zero with a variance that the group has of its own. These variances and the
noise's are those that make the signal likeliest when the amplitudes are integrated out
(type-II maximum likelihood). A group that explains nothing gets no variance, so that it
costs nothing to offer it; one that explains something is charged for its freedom.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg.lapack import dpotrf, dtrtri

from hystbench.record import FloatArray

STEPS = 25
"""Of the fixed-point iteration."""
NOTHING = 1e-12
"""Share of the signal's power below which a variance is taken as zero."""


@dataclass(frozen=True)
class Grouped:
    """A signal explained by groups of columns."""

    noise: float
    """Variance of what no group explains, freedom charged."""
    variances: FloatArray
    """Shape (groups,). Of the amplitudes of each group's columns."""
    evidence: float
    """Logarithm of the probability density of the signal."""
    amplitudes: FloatArray
    """Shape (columns,). The likeliest, of the columns in the order of the groups."""


@dataclass(frozen=True, eq=False)
class ColumnProducts:
    """Products of all columns with each other and with a signal."""

    gram: FloatArray
    """Shape (k, k). Of columns of unit mean square, times their sizes; those that are
    zero stay zero."""
    across: FloatArray
    """Shape (k,). Of the columns with the signal."""
    power: float
    """Sum of squares of the signal."""
    rows: int
    """Samples of the signal."""
    sizes: FloatArray
    """Shape (k,). By which the columns were divided."""

    @classmethod
    def of(
        cls, columns: FloatArray, signal: FloatArray, sizes: FloatArray | float = 1.0
    ) -> ColumnProducts:
        """Multiply columns, shape (n, k), and a signal, shape (n,).

        Parameters
        ----------
        columns, signal : ndarray
        sizes : ndarray, shape (k,), or float
            RMS that the columns are given; in a group the amplitude of a column is
            expected to be in proportion to it.
        """
        gram = columns.T @ columns
        size = np.sqrt(gram.diagonal() / len(signal))
        size = np.where(size > 0, size, 1.0) / sizes
        return cls(
            gram / np.outer(size, size),
            columns.T @ signal / size,
            float(signal @ signal),
            len(signal),
            size,
        )

    def of_another(self, columns: FloatArray, signal: FloatArray) -> ColumnProducts:
        """Give the products of the same columns with another signal."""
        across = columns.T @ signal / self.sizes
        return replace(self, across=across, power=float(signal @ signal))

    def explained(self, groups: Sequence[Sequence[int]]) -> Grouped:
        """Find the variances of groups and of the noise, by evidence.

        MacKay's fixed-point steps [1]_: with ``g`` the amplitudes of a group that the
        signal determines, its variance becomes the sum of their squares over ``g``, and
        the noise's the squares that are left over the samples less all ``g``.

        Parameters
        ----------
        groups : sequence of sequence of int
            Columns of each group; the columns of none are left out.

        Returns
        -------
        Grouped
            Of the groups that have a column.

        References
        ----------
        .. [1] D. J. C. MacKay, "Bayesian interpolation", Neural Computation 4 (1992)
           415-447.
        """
        groups = [group for group in groups if len(group)]
        noise = max(self.power / self.rows, np.finfo(float).tiny)
        if not groups:
            evidence = self._evidence(noise, 0.0, self.power)
            return Grouped(noise, np.zeros(0), evidence, np.zeros(0))
        used = np.concatenate([np.asarray(group, dtype=np.intp) for group in groups])
        member = np.repeat(np.arange(len(groups)), [len(group) for group in groups])
        counts = np.bincount(member)
        gram, across = self.gram[np.ix_(used, used)], self.across[used]
        variances = noise / counts
        least = NOTHING * noise
        for step in range(STEPS + 1):
            root = np.sqrt(variances)[member]
            white, inverse, determinant = _solved(gram, across, root, noise)
            amplitudes = root * white
            left = self.power - amplitudes @ (2 * across - gram @ amplitudes)
            left = max(float(left), least * self.rows)
            if step == STEPS:
                break
            known = 1.0 - np.einsum("ij,ij->j", inverse, inverse)
            each = np.maximum(np.bincount(member, known), NOTHING)
            squares = variances * np.bincount(member, white**2)
            variances = np.maximum(squares / each, least * NOTHING)
            noise = left / max(self.rows - float(each.sum()), 1.0)
        power = left + noise * float(white @ white)
        evidence = self._evidence(noise, determinant, power)
        return Grouped(noise, variances, evidence, amplitudes)

    def power_beyond(
        self,
        columns: Sequence[int],
        amplitudes: FloatArray,
        own: Sequence[int],
        noise: float,
        variances: FloatArray,
    ) -> float:
        """Give the mean square of a sum of columns beyond what others may take of it.

        Parameters
        ----------
        columns : sequence of int
        amplitudes : ndarray, shape (columns,)
            Of the sum.
        own : sequence of int
            The other columns.
        noise : float
            Variance of the noise.
        variances : ndarray, shape (own,)
            Of the amplitudes of the others.
        """
        gram, root = self.gram[np.ix_(own, own)], np.sqrt(variances)
        across = self.gram[np.ix_(own, columns)] @ amplitudes
        taken = root * _solved(gram, across, root, noise)[0]
        power = amplitudes @ self.gram[np.ix_(columns, columns)] @ amplitudes
        power -= taken @ (2 * across - gram @ taken)
        return max(float(power), 0.0) / self.rows

    def _evidence(self, noise: float, determinant: float, power: float) -> float:
        """Give the log density: ``power`` over the noise is the exponent's double."""
        spread = self.rows * float(np.log(2 * np.pi * noise))
        return -0.5 * (spread + determinant + power / noise)


def _solved(
    gram: FloatArray, across: FloatArray, root: FloatArray, noise: float
) -> tuple[FloatArray, FloatArray, float]:
    """Solve for amplitudes, in standard deviations ``root`` of what they may be.

    Returns
    -------
    amplitudes : ndarray, shape (k,)
        Posterior mean, over ``root``.
    inverse, determinant : ndarray, float
        Of one plus the products over the noise: as :func:`_factored` gives them.
    """
    scaled = gram * (root[:, None] * root) / noise
    scaled.flat[:: len(root) + 1] += 1.0
    inverse, determinant = _factored(scaled)
    return inverse.T @ (inverse @ (root * across)) / noise, inverse, determinant


def _factored(matrix: FloatArray) -> tuple[FloatArray, float]:
    """Give ``W`` with ``W^T W`` the inverse, and the determinant's logarithm.

    The matrix is one plus what is not negative, so its eigenvalues are at least one.
    Where noise is so small that rounding hides the one, they are set to it.
    """
    lower, failed = dpotrf(matrix, lower=1)
    if not failed:
        inverse, _ = dtrtri(lower, lower=1)
        return np.tril(inverse), 2.0 * float(np.sum(np.log(np.diag(lower))))
    values, vectors = np.linalg.eigh(matrix)
    values = np.maximum(values, 1.0)
    return (vectors / np.sqrt(values)).T, float(np.sum(np.log(values)))
