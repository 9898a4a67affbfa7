"""One number for how much of a gap is left, and the amplitudes that make it least.

The residual of a candidate is split, by an orthonormal basis of what a wrong shape of
the hysteresis could do, into ``a`` (inside, ``d`` directions) and ``c`` (the rest).
With ``s_i`` the mean square of ``c`` in record ``i``, ``f`` the noise floor's mean
square and ``p`` the number of fitted parameters the score is

    sum_i W log(max(s_i, f)) + d log(max(|a|^2 / d, f)) + P p

``W`` is some fifty: a record counts as that many independent samples. So reshaping the
hysteresis is allowed and is charged, and both terms saturate.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from hashlib import blake2b
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hystbench.gap.records.sample import Sample
from hystbench.gap.thresholds import LEAST_WEIGHT, PARAMETER, RECORD_WEIGHT
from hystbench.record import FloatArray

ROUNDS = 4
"""Of reweighting: amplitudes change little after."""
STILL = 1e-3
"""A round that changes the score by less is the last."""
KNOWN = 1e-5
"""Least over largest pivot of products that tell all columns apart."""
FEW = 12
"""Columns of which none is looked for that is zero in a record."""


class Amplitudes(NamedTuple):
    """Amplitudes of linear terms, and the score with them."""

    values: FloatArray  # shape (k,)
    score: float


@dataclass(frozen=True, eq=False)
class Score:
    """What is held fixed while candidates are scored.

    Parameters
    ----------
    sample : Sample
    directions : ndarray, shape (scored samples, d)
        Orthonormal: what a wrong shape of the hysteresis could do.
    floor : float
        Mean square of what no model explains, in squared output units.
    used : tuple of ndarray of bool, optional
        Of each record's scored samples, those that count; by default all.
    """

    sample: Sample
    directions: FloatArray
    floor: float
    used: tuple[NDArray[np.bool_], ...] | None = None

    @cached_property
    def parts(self) -> tuple[NDArray[np.intp], ...]:
        """Which scored samples count, by record; records without any are left out."""
        places = [np.arange(part.start, part.stop) for part in self.sample.slices]
        if self.used is not None:
            places = [p[u] for p, u in zip(places, self.used, strict=True)]
        return tuple(p for p in places if len(p))

    @cached_property
    def digest(self) -> str:
        """Digest of all that the score holds fixed, but for the samples' places."""
        whole = blake2b(repr((self.floor, self.directions.shape)).encode())
        whole.update(self.directions.tobytes())
        for used in self.used or ():
            whole.update(used.tobytes())
        return whole.hexdigest()

    @property
    def weight(self) -> float:
        """Independent samples that each record counts as."""
        return max(RECORD_WEIGHT, LEAST_WEIGHT / len(self.sample.positions))

    def split(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Split signals into the rest and the amplitudes of the directions.

        Parameters
        ----------
        values : ndarray, shape (scored samples,) or (scored samples, k)

        Returns
        -------
        rest : ndarray, of the same shape
        inside : ndarray, shape (d,) or (d, k)
        """
        inside = self.directions.T @ values
        return values - self.directions @ inside, inside

    def least(self, freedom: float = 0.0) -> float:
        """Give the score of a residual that is noise: none can be less."""
        return self._value(np.zeros(len(self.parts)), 0.0, freedom)

    def of(self, residual: FloatArray, freedom: float = 0.0) -> float:
        """Score a residual, shape (scored samples,), of that many parameters."""
        rest, inside = self.split(residual)
        squares = [float(np.mean(rest[part] ** 2)) for part in self.parts]
        return self._value(np.array(squares), float(inside @ inside), freedom)

    def amplitudes(
        self,
        residual: FloatArray,
        columns: FloatArray,
        freedom: float = 0.0,
        stiffness: FloatArray | None = None,
        positive: Sequence[int] = (),
    ) -> Amplitudes:
        """Find amplitudes of columns whose sum, taken off the residual, scores least.

        Reweighted least squares: the score is a sum of logarithms of squares, so each
        record counts by the inverse of its mean square.

        Parameters
        ----------
        residual : ndarray, shape (scored samples,)
        columns : ndarray, shape (scored samples, k)
        freedom : float
            Fitted parameters to be charged.
        stiffness : ndarray, shape (k,), optional
            Charge for the square of each amplitude (a tolerance's inverse square).
        positive : sequence of int
            Columns whose amplitude may not be negative.
        """
        k = columns.shape[1]
        if not (np.isfinite(columns).all() and np.isfinite(residual).all()):
            return Amplitudes(np.zeros(k), np.inf)  # a model that runs away
        if k == 0:
            return Amplitudes(np.zeros(0), self.of(residual, freedom))
        scale = np.sqrt(np.einsum("ij,ij->j", columns, columns) / len(columns))
        scale[scale == 0] = 1.0
        grams, within = self._products(np.column_stack([residual, columns / scale]))
        flat, inner = grams.reshape(len(grams), -1), within.ravel()
        charge = np.zeros(k) if stiffness is None else stiffness / scale**2
        d = max(self.directions.shape[1], 1)
        full, last = np.eye(1, k + 1)[0], np.inf
        best = (np.inf, full)
        for _ in range(ROUNDS + 1):
            both = np.outer(full, full).ravel()
            squares = np.maximum(flat @ both, 0.0) / self._counts
            power = max(float(inner @ both), 0.0)
            value = self._value(squares, power, freedom) + float(charge @ full[1:] ** 2)
            if value < best[0]:
                best = (value, full)
            if abs(last - value) < STILL:
                break
            last = value
            weights = self.weight / (self._counts * np.maximum(squares, self.floor))
            normal = weights @ flat + d / max(power, d * self.floor) * inner
            normal = normal.reshape(k + 1, k + 1)
            matrix = normal[1:, 1:].copy()
            np.fill_diagonal(matrix, matrix.diagonal() * (1 + 1e-12) + charge)
            beta = _solve(matrix, normal[1:, 0], positive)
            full = np.concatenate([[1.0], -beta])
        return Amplitudes(-best[1][1:] / scale, best[0])

    @cached_property
    def _counts(self) -> NDArray[np.intp]:
        """Samples that count, by record."""
        return np.array([len(part) for part in self.parts])

    @cached_property
    def _stacked(self) -> FloatArray | None:
        """Directions by record, where as many samples count in each, in one piece."""
        alike = len({len(part) for part in self.parts}) == 1
        whole = all(isinstance(_place(part), slice) for part in self.parts)
        return _stack(self.directions, self.parts) if alike and whole else None

    @cached_property
    def _spreads(self) -> FloatArray:
        return np.stack(self._spread)

    @cached_property
    def _rows(self) -> tuple[FloatArray, ...]:
        """Rows of the directions that count, by record."""
        return tuple(self.directions[_place(part)] for part in self.parts)

    @cached_property
    def _spread(self) -> tuple[FloatArray, ...]:
        """Products of the directions with each other, by record."""
        return tuple(rows.T @ rows for rows in self._rows)

    def _products(self, table: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Give products of columns with each other, of the rest and inside.

        Returns
        -------
        grams : ndarray, shape (parts, k, k)
            Of what is left of the columns beyond the directions, by record.
        within : ndarray, shape (k, k)
            Of the amplitudes of the directions.

        Notes
        -----
        What is left is never computed: with ``Q`` a record's rows of the directions,
        ``C`` of the columns and ``A`` the amplitudes, its products are
        ``C'C - A'Q'C - C'Q A + A'Q'Q A``. Columns that are zero in a record, as those
        of a signal that each record has of its own, cost nothing there.
        """
        k, d = table.shape[1], self.directions.shape[1]
        if self._stacked is not None and k <= FEW:
            rows = _stack(table, self.parts)
            turned = rows.transpose(0, 2, 1)
            across = turned @ self._stacked
            whole = self.used is None
            inside = across.sum(axis=0) if whole else table.T @ self.directions
            mixed = across @ inside.T
            grams = turned @ rows + inside @ self._spreads @ inside.T
            grams -= mixed
            grams -= mixed.transpose(0, 2, 1)
            return grams, inside @ inside.T
        pieces = []
        for part, directions in zip(self.parts, self._rows, strict=True):
            rows = table[_place(part)]
            there = np.flatnonzero(rows.any(axis=0)) if rows.shape[1] > FEW else None
            own = rows if there is None else rows[:, there]
            pieces.append((there, own.T @ own, directions.T @ own))
        if self.used is None:
            inside = np.zeros((d, k))
            for there, _, across in pieces:
                inside[:, slice(None) if there is None else there] += across
        else:
            inside = self.directions.T @ table
        grams = np.empty((len(pieces), k, k))
        for gram, spread, (there, own, across) in zip(
            grams, self._spread, pieces, strict=True
        ):
            np.matmul(inside.T, spread @ inside, out=gram)
            place = slice(None) if there is None else there
            mixed = inside.T @ across
            gram[:, place] -= mixed
            gram[place] -= mixed.T
            gram[place if there is None else np.ix_(there, there)] += own
        return grams, inside.T @ inside

    def _value(self, squares: FloatArray, power: float, freedom: float) -> float:
        d = self.directions.shape[1]
        outside = self.weight * float(np.sum(np.log(np.maximum(squares, self.floor))))
        inside = d * np.log(max(power / d, self.floor)) if d else 0.0
        return outside + float(inside) + PARAMETER * freedom


def _stack(table: FloatArray, parts: Sequence[NDArray[np.intp]]) -> FloatArray:
    """Give a table's rows by record, which have as many each: shape (parts, n, k)."""
    n, k = len(parts[0]), table.shape[1]
    if n * len(parts) == len(table):
        return table.reshape(len(parts), n, k)
    return np.stack([table[_place(part)] for part in parts])


def _place(part: NDArray[np.intp]) -> slice | NDArray[np.intp]:
    """Give a view's slice where samples stand in one piece, as they mostly do."""
    whole = part[-1] - part[0] + 1 == len(part)
    return slice(part[0], part[-1] + 1) if whole else part


def _solve(
    matrix: FloatArray, vector: FloatArray, positive: Sequence[int]
) -> FloatArray:
    """Solve normal equations; amplitudes that must not be negative are set to zero."""
    active = np.ones(len(vector), dtype=bool)
    for _ in range(len(vector) + 1):
        beta: FloatArray = np.zeros(len(vector))
        if active.all():
            beta[:] = _solution(matrix, vector)
        else:
            keep = np.flatnonzero(active)
            beta[keep] = _solution(matrix[np.ix_(keep, keep)], vector[keep])
        negative = [k for k in positive if active[k] and beta[k] < 0]
        if not negative:
            return beta
        active[min(negative, key=lambda k: beta[k])] = False
    return beta


def _solution(matrix: FloatArray, vector: FloatArray) -> FloatArray:
    """Solve a symmetric system; directions that it hardly knows stay at zero."""
    if len(vector) == 1 and matrix[0, 0] > 0:  # as most are
        return np.asarray(vector / matrix[0])
    try:
        pivots = np.linalg.cholesky(matrix).diagonal()
    except np.linalg.LinAlgError:
        pivots = np.zeros(len(vector))
    if (pivots > KNOWN * pivots.max(initial=0.0)).all():  # elimination is quicker
        return np.asarray(np.linalg.solve(matrix, vector), dtype=np.float64)
    return np.asarray(np.linalg.lstsq(matrix, vector, rcond=1e-13)[0])
