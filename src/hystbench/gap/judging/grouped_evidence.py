"""Least squares with a prior variance for each group of columns, found by evidence.

A signal is a sum of columns and white noise. The amplitudes of a group of columns are
normal about zero with a variance that the group has of its own. These variances and the
noise's are those that make the signal likeliest when the amplitudes are integrated out
(type-II maximum likelihood). A group that explains nothing gets no variance, so that it
costs nothing to offer it; one that explains something is charged for its freedom.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dpotrf, dtrtri

from hystbench.record import FloatArray

Groups = Mapping[str, FloatArray]
"""Columns by group, shape (samples, k) each; a group may have none."""

STEPS = 25
"""Steps of the fixed-point iteration."""
NOTHING = 1e-12
"""Share of the signal's power below which a variance is taken as zero."""


@dataclass(frozen=True)
class Grouped:
    """A signal explained by groups of columns."""

    noise: float
    """Variance of what no group explains, freedom charged."""
    variances: Mapping[str, float]
    """Variance of the amplitudes of each group's columns."""
    evidence: float
    """Logarithm of the probability density of the signal."""
    amplitudes: Groups
    """The likeliest of each group, shape (k,)."""


@dataclass(frozen=True, eq=False)
class ColumnProducts:
    """Products of all columns with each other and with a signal."""

    columns: FloatArray
    """Shape (samples, k)."""
    places: Mapping[str, NDArray[np.intp]]
    """Which of them are of each group."""
    gram: FloatArray
    """Shape (k, k). Of columns of unit mean square, times their sizes; those that are
    zero stay zero."""
    across: FloatArray
    """Shape (k,). Of the columns with the signal."""
    power: float
    """Sum of squares of the signal."""
    sizes: FloatArray
    """Shape (k,). By which the columns were divided."""

    @classmethod
    def of(
        cls, groups: Groups, signal: FloatArray, sizes: Groups | None = None
    ) -> ColumnProducts:
        """Multiply columns and a signal, shape (samples,).

        Parameters
        ----------
        groups : mapping
        signal : ndarray
        sizes : mapping, optional
            RMS that the columns of a group are given, shape (k,), one by default; the
            amplitude of a column is expected to be in proportion to it.
        """
        columns = np.hstack(list(groups.values()))
        ends = np.cumsum([0, *(own.shape[1] for own in groups.values())])
        each = zip(groups, pairwise(ends.tolist()), strict=True)
        places = {name: np.arange(*at) for name, at in each}
        gram = columns.T @ columns
        size = np.sqrt(gram.diagonal() / len(signal))
        size = np.where(size > 0, size, 1.0)
        for name, own in (sizes or {}).items():
            size[places[name]] /= own
        return cls(
            columns,
            places,
            gram / np.outer(size, size),
            columns.T @ signal / size,
            float(signal @ signal),
            size,
        )

    def of_another(self, signal: FloatArray) -> ColumnProducts:
        """Give the products of the same columns with another signal."""
        across = self.columns.T @ signal / self.sizes
        return replace(self, across=across, power=float(signal @ signal))

    def explained(self, names: Collection[str]) -> Grouped:
        """Find the variances of groups and of the noise, by evidence.

        MacKay's fixed-point steps [1]_: with ``g`` the amplitudes of a group that the
        signal determines, its variance becomes the sum of their squares over ``g``, and
        the noise's the squares that are left over the samples less all ``g``.

        Parameters
        ----------
        names : collection of str
            Of the groups that are offered.

        Returns
        -------
        Grouped
            Of those that have a column.

        References
        ----------
        .. [1] D. J. C. MacKay, "Bayesian interpolation", Neural Computation 4 (1992)
           415-447.
        """
        names = [name for name in names if len(self.places[name])]
        rows = len(self.columns)
        noise = max(self.power / rows, np.finfo(float).tiny)
        if not names:
            return Grouped(noise, {}, self._evidence(noise, 0.0, self.power), {})
        counts = np.array([len(self.places[name]) for name in names])
        member = np.repeat(np.arange(len(names)), counts)
        used = self._at(names)
        gram, across = self.gram[np.ix_(used, used)], self.across[used]
        variances = noise / counts
        least = NOTHING * noise
        for step in range(STEPS + 1):
            root = np.sqrt(variances)[member]
            white, inverse, determinant = _solved(gram, across, root, noise)
            amplitudes = root * white
            taken = float(amplitudes @ (2 * across - gram @ amplitudes))
            left = max(self.power - taken, least * rows)
            if step == STEPS:
                break
            known = 1.0 - np.einsum("ij,ij->j", inverse, inverse)
            each = np.maximum(np.bincount(member, known), NOTHING)
            squares = variances * np.bincount(member, white**2)
            variances = np.maximum(squares / each, least * NOTHING)
            noise = left / max(rows - float(each.sum()), 1.0)
        power = left + noise * float(white @ white)
        evidence = self._evidence(noise, determinant, power)
        parts = np.split(amplitudes, np.cumsum(counts)[:-1])
        return Grouped(
            noise,
            dict(zip(names, variances.tolist(), strict=True)),
            evidence,
            dict(zip(names, parts, strict=True)),
        )

    def power_beyond(
        self, names: Collection[str], own: Collection[str], found: Grouped
    ) -> float:
        """Give the mean square of a sum of columns beyond what others may take of it.

        Parameters
        ----------
        names : collection of str
            Groups of the columns.
        own : collection of str
            Groups of the others.
        found : Grouped
            The amplitudes of the columns, the variances of the others, and the noise's.
        """
        names, own = ([x for x in each if len(self.places[x])] for each in (names, own))
        if not names:
            return 0.0
        at, others = self._at(names), self._at(own)
        amplitudes = np.concatenate([found.amplitudes[name] for name in names])
        counts = [len(self.places[name]) for name in own]
        root = np.sqrt(np.repeat([found.variances[name] for name in own], counts))
        gram = self.gram[np.ix_(others, others)]
        across = self.gram[np.ix_(others, at)] @ amplitudes
        taken = root * _solved(gram, across, root, found.noise)[0]
        power = amplitudes @ self.gram[np.ix_(at, at)] @ amplitudes
        power -= taken @ (2 * across - gram @ taken)
        return max(float(power), 0.0) / len(self.columns)

    def _at(self, names: Collection[str]) -> NDArray[np.intp]:
        """Give the places of the columns of groups."""
        return np.concatenate([self.places[name] for name in names])

    def _evidence(self, noise: float, determinant: float, power: float) -> float:
        """Give the log density: ``power`` over the noise is the exponent's double."""
        spread = len(self.columns) * float(np.log(2 * np.pi * noise))
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
