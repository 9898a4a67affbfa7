"""One number for how much of a gap is left, and the amplitudes that make it least.

The residual of a candidate is split, by an orthonormal basis of what a wrong shape of
the hysteresis could do, into ``a`` (inside, ``d`` directions) and ``c`` (the rest).
With ``s_i`` the mean square of ``c`` in record ``i``, ``f`` the noise floor's mean
square, ``p`` the number of fitted parameters and ``h`` what is charged for moving
numbers that are held (:class:`Held`), the score is

    sum_i W_i log(max(s_i, f)) + d log(max(|a|^2 / d, f)) + P p + h

A record counts as ``W_i`` independent samples: on average :func:`record_weight`, and by
its number of scored samples. So reshaping the hysteresis is allowed and is charged, and
the first two terms saturate.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from hashlib import blake2b
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hystbench.errors import InputError
from hystbench.gap.fitting import normal_equations
from hystbench.gap.fitting.held import Held
from hystbench.gap.fitting.normal_equations import column_rms, joined, solve
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.thresholds import LEAST_WEIGHT, PARAMETER, RECORD_WEIGHT
from hystbench.record import FloatArray

ROUNDS = 4
"""Rounds of reweighting: amplitudes change little after."""
STILL = 1e-3
"""A round that changes the score by less is the last."""
APART = 1e-12
"""Least over largest power of combinations of columns that are solved for."""


class Amplitudes(NamedTuple):
    """Amplitudes of linear terms, and the score with them."""

    values: FloatArray  # shape (k,)
    score: float


class Products(NamedTuple):
    """Products of columns with each other and with the directions, as forms of them."""

    grams: FloatArray
    """Shape (parts, k, k). With each other, of what is left beyond the directions, by
    record."""
    inside: FloatArray
    """Shape (d, k). Amplitudes of the directions."""


class Shared(NamedTuple):
    """Columns that many calls solve for beside their own."""

    own: Products
    charge: FloatArray
    """Shape (1 + k, 1 + k). See :meth:`Held.form`."""
    table: FloatArray
    """Shape (parts, n, d + k). The directions and the columns, by record."""
    across: FloatArray
    """Shape (parts, d, k). Products of the directions with what is left of the columns
    beyond them."""


class Told(NamedTuple):
    """What the samples tell of amplitudes, whatever holds them."""

    own: int
    """Amplitudes that are given; those of further columns are not."""
    scale: FloatArray
    """Shape (own,). Root mean squares of their columns."""
    forms: FloatArray | None
    """Shape (parts + 1, (1 + k)^2). Of each record, and of the directions, a quadratic
    form of (1, -b); None where a signal is not finite, as of a model that runs away."""
    charge: FloatArray
    """Shape (1 + k, 1 + k). What holds the further columns."""


def record_weight(records: int) -> float:
    """Give the independent samples that each of so many records counts as."""
    return max(RECORD_WEIGHT, LEAST_WEIGHT / records)


@dataclass(frozen=True, eq=False)
class Score:
    """What is held fixed while candidates are scored."""

    sample: ScoredSamples
    directions: FloatArray
    """Shape (scored samples, d). Orthonormal: what a wrong shape of the hysteresis
    could do."""
    floor: float
    """Mean square of what no model explains, in squared output units."""
    used: tuple[NDArray[np.bool_], ...] | None = None
    """Which of each record's scored samples count; by default all."""

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

    @classmethod
    def plain(cls, sample: ScoredSamples, floor: float) -> Score:
        """Give a score of residuals as they are, with no direction to spare."""
        return cls(sample, np.zeros((len(sample), 0)), floor)

    @cached_property
    def weight(self) -> float:
        """Independent samples that a record counts as on average."""
        return record_weight(len(self.sample.positions))

    @cached_property
    def weights(self) -> FloatArray:
        """Independent samples each record counts as: a short one shows fewer waves."""
        counts = np.array([len(own) for own in self.sample.positions], dtype=float)
        return self.weight * counts / max(float(np.mean(counts)), 1e-300)

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
        held: Held | None = None,
        positive: Sequence[int] = (),
        beside: Shared | None = None,
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
        held : Held, optional
            What holds the amplitudes of the columns; by default nothing.
        positive : sequence of int
            Columns whose amplitude may not be negative.
        beside : Shared, optional
            Of further columns, which many calls share: see :meth:`shared`. Their
            amplitudes are not given.
        """
        told = self.told(residual, columns, beside)
        return self.solved(told, freedom, held, positive)

    def told(
        self, residual: FloatArray, columns: FloatArray, beside: Shared | None = None
    ) -> Told:
        """Take from the samples all that :meth:`solved` needs of them."""
        own = columns.shape[1]
        k = own + (0 if beside is None else len(beside.charge) - 1)
        charge = np.zeros((k + 1, k + 1))
        if beside is not None:
            theirs = beside.charge
            charge[0, 0] = theirs[0, 0]
            charge[0, own + 1 :] = charge[own + 1 :, 0] = theirs[0, 1:]
            charge[own + 1 :, own + 1 :] = theirs[1:, 1:]
        whole = np.column_stack([residual, columns])
        if not np.isfinite(whole).all():
            return Told(own, np.ones(own), None, charge)
        scale = column_rms(columns)
        whole[:, 1:] /= scale
        found = self._products(whole, beside)
        within = found.inside.T @ found.inside
        forms = np.concatenate([found.grams, [within]])
        return Told(own, scale, forms.reshape(len(forms), -1), charge)

    def solved(
        self,
        told: Told,
        freedom: float = 0.0,
        held: Held | None = None,
        positive: Sequence[int] = (),
    ) -> Amplitudes:
        """Do what :meth:`amplitudes` does, of what the samples tell."""
        own, scale, forms, charge = told
        if forms is None:
            return Amplitudes(np.zeros(own), np.inf)
        k = len(charge) - 1
        if held is not None:
            charge = charge.copy()
            charge[: own + 1, : own + 1] += held.form(np.diag(1 / scale))
        forms = np.concatenate([forms, charge.reshape(1, -1)])
        d = max(self.directions.shape[1], 1)
        full, last = np.eye(1, k + 1)[0], np.inf
        best = (np.inf, full)
        for left in reversed(range(ROUNDS + 1)):
            squares = forms @ (full[:, None] * full).ravel()
            charged = float(squares[-1])
            squares = np.maximum(squares[:-1], 0.0)
            power = float(squares[-1])
            squares = squares[:-1] / self._counts
            value = self._value(squares, power, freedom) + charged
            if value < best[0]:
                best = (value, full)
            if k == 0 or left == 0 or abs(last - value) < STILL:
                break
            last = value
            weights = self._weights(squares)
            of_inside = d / max(power, d * self.floor)
            normal = np.concatenate([weights, [of_inside, 1.0]]) @ forms
            normal = normal.reshape(k + 1, k + 1)
            matrix = normal[1:, 1:]
            matrix.flat[:: k + 1] *= 1 + APART  # alike columns have a solution too
            beta = solve(matrix, normal[1:, 0], positive)
            full = np.concatenate([[1.0], -beta])
        return Amplitudes(-best[1][1 : own + 1] / scale, best[0])

    def shared(self, columns: FloatArray, held: Held | None = None) -> Shared:
        """Prepare columns that many calls solve for beside their own.

        They are replaced by combinations that are at right angles, those that the
        samples and the charge tell apart.

        Parameters
        ----------
        columns : ndarray, shape (scored samples, k)
        held : Held, optional
            What holds the amplitudes of the columns; by default nothing.
        """
        scale = column_rms(columns)
        held = Held.here(np.zeros(len(scale))) if held is None else held
        columns, charge = columns / scale, np.diag(held.stiffness / scale**2)
        power = columns.T @ columns / len(columns)
        if not np.isfinite(power).all():
            raise InputError("a number that may be re-tuned makes the model diverge")
        whole = power + charge
        # A number that is held fast must not make those beside it look like nothing.
        size = np.sqrt(np.maximum(whole.diagonal(), APART))
        values, vectors = np.linalg.eigh(whole / np.outer(size, size))
        kept = values > APART * values.max(initial=0.0)
        turned = vectors[:, kept] / np.sqrt(values[kept]) / size[:, None]
        columns = columns @ turned
        own = self._products(columns)
        rows = self._by_record(columns)
        across = self._directions.mT @ rows - self._spread @ own.inside
        table = np.concatenate([self._directions, rows], axis=2)
        return Shared(own, held.form(turned / scale[:, None]), table, across)

    def numbers_told(
        self, residual: FloatArray, columns: FloatArray, held: Held
    ) -> float:
        """Count the amplitudes that samples tell, in place of what holds them.

        Each combination of amplitudes counts by the share of what is known of it that
        the samples say: the effective number of parameters [1]_.

        Parameters
        ----------
        residual : ndarray, shape (scored samples,)
        columns : ndarray, shape (scored samples, k)
        held : Held
            What holds the amplitudes; one that is not held counts as one.

        References
        ----------
        .. [1] D. J. C. MacKay, "Bayesian interpolation", Neural Computation 4 (1992)
           415-447, Sec. 4.4.
        """
        found = self._products(np.column_stack([residual, columns]))
        squares = found.grams[:, 0, 0] / self._counts
        weights = self._weights(squares)
        told = np.tensordot(weights, found.grams[:, 1:, 1:], 1)
        whole = told + np.diag(held.stiffness)
        size = np.sqrt(np.maximum(whole.diagonal(), APART))
        told, whole = (each / np.outer(size, size) for each in (told, whole))
        return float(np.trace(np.linalg.lstsq(whole, told, rcond=APART)[0]))

    def _products(self, columns: FloatArray, beside: Shared | None = None) -> Products:
        """Give products of columns with each other and with those beside, by record.

        Notes
        -----
        What is left of them beyond the directions is never computed: with ``Q`` a
        record's rows of the directions, ``C`` of the columns and ``A`` the amplitudes,
        its products are ``C'C - A'Q'C - C'Q A + A'Q'Q A``.
        """
        rows = self._by_record(columns)
        d = self.directions.shape[1]
        every = rows.mT @ (self._directions if beside is None else beside.table)
        across = every[:, :, :d]  # of the columns with the directions
        whole = self.used is None
        inside = across.sum(axis=0).T if whole else self.directions.T @ columns
        half = across @ inside
        grams = rows.mT @ rows - half - half.mT + inside.T @ self._spread @ inside
        if beside is None:
            return Products(grams, inside)
        other = beside.own
        mixed = every[:, :, d:] - across @ other.inside - inside.T @ beside.across
        return Products(
            joined(grams, mixed, other.grams),
            np.hstack([inside, other.inside]),
        )

    @cached_property
    def _weights_of_parts(self) -> FloatArray:
        """Independent samples of the records of which some samples count."""
        if self.used is None:
            return self.weights[self.weights > 0.0]
        return self.weights[[bool(own.any()) for own in self.used]]

    @cached_property
    def _counts(self) -> NDArray[np.intp]:
        """Samples that count, by record."""
        return np.array([len(part) for part in self.parts])

    @cached_property
    def _directions(self) -> FloatArray:
        return self._by_record(self.directions)

    @cached_property
    def _spread(self) -> FloatArray:
        """Products of the directions with each other, by record."""
        return np.asarray(self._directions.mT @ self._directions)

    def _by_record(self, table: FloatArray) -> FloatArray:
        """Give the rows that count, shape (parts, n, k); zeros where a record has less.

        Those add nothing to a product.
        """
        n = int(self._counts.max())
        if (self._counts == n).all() and n * len(self.parts) == len(table):
            return table.reshape(len(self.parts), n, -1)
        out = np.zeros((len(self.parts), n, table.shape[1]))
        for own, part in zip(out, self.parts, strict=True):
            own[: len(part)] = table[normal_equations.in_one_piece(part)]
        return out

    def _weights(self, squares: FloatArray) -> FloatArray:
        """Give what a sum of squares counts, by record, beside such mean squares."""
        powers = self._counts * np.maximum(squares, self.floor)
        return self._weights_of_parts / powers

    def _value(self, squares: FloatArray, power: float, freedom: float) -> float:
        logs = np.log(np.maximum(squares, self.floor))
        outside = float(self._weights_of_parts @ logs)
        return outside + self.of_directions(power) + PARAMETER * freedom

    def of_directions(self, power: float) -> float:
        """Give the term of the directions, whose amplitudes have a sum of squares."""
        d = self.directions.shape[1]
        return d * float(np.log(max(power / d, self.floor))) if d else 0.0
