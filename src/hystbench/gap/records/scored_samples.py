"""A record beside its simulation, and which of its samples are scored.

Model error is not white, so more than about a thousand samples of a record say little
more; fewer make a refit cheap. Simulation always runs over the whole record. Samples
that were not measured are never scored.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hystbench.record import FloatArray, Record

SAMPLES = 1000
"""Scored samples of a record."""


Line = tuple[NDArray[np.intp], FloatArray]
"""Samples, and the shares of the way to the next ones."""


@dataclass(frozen=True)
class ScoredSamples:
    """Positions of the scored samples in each record."""

    positions: tuple[NDArray[np.intp], ...]
    """Positions of the scored samples in each record, increasing."""
    of_start: tuple[FloatArray, ...] = ()
    """Shape (samples, columns) each. What is not known of the first sample of each
    record does there; it is taken off every signal. By default all is known."""
    apart: tuple[int, ...] = ()
    """Samples from one to the next at which signals are given, by record; they are
    straight lines in between. By default they are given at all samples."""

    @classmethod
    def of(cls, records: Sequence[Record], count: int = SAMPLES) -> ScoredSamples:
        """Take one sample, at random, of each of ``count`` equal stretches."""
        rng = np.random.default_rng(0)
        positions = []
        for record in records:
            measured = np.flatnonzero(record.counted)
            n = len(measured)
            edges = np.linspace(0, n, min(count, n) + 1).astype(np.intp)
            place = rng.random(len(edges) - 1)
            chosen = edges[:-1] + (place * np.diff(edges)).astype(np.intp)
            positions.append(measured[chosen])
        if not any(record.of_start.shape[1] for record in records):
            return cls(tuple(positions))
        of_start = [
            record.of_start[own] for record, own in zip(records, positions, strict=True)
        ]
        return cls(tuple(positions), tuple(of_start))

    def on(self, kept: Sequence[int]) -> ScoredSamples:
        """Give the sample of some of the records, by number."""
        return ScoredSamples(
            tuple(self.positions[k] for k in kept),
            tuple(self.of_start[k] for k in kept) if self.of_start else (),
            tuple(self.apart[k] for k in kept) if self.apart else (),
        )

    @cached_property
    def slices(self) -> tuple[slice, ...]:
        """Where each record's samples lie in a vector of all of them."""
        ends = np.cumsum([0, *map(len, self.positions)])
        return tuple(slice(a, b) for a, b in itertools.pairwise(ends.tolist()))

    def __len__(self) -> int:
        """Count the scored samples of all records."""
        return sum(map(len, self.positions))

    def take(self, signals: Sequence[FloatArray]) -> FloatArray:
        """Take the scored samples of one signal a record.

        Parameters
        ----------
        signals : sequence of ndarray
            By record, shape (n,) or (n, k).

        Returns
        -------
        ndarray, shape (scored samples,) or (scored samples, k)
        """
        if self.apart:
            lines = self._lines(tuple(map(len, signals)))
            taken = [_between(x, *at) for x, at in zip(signals, lines, strict=True)]
        else:
            taken = [x[p] for x, p in zip(signals, self.positions, strict=True)]
        found = np.concatenate(taken)
        return self._without_starts(found) if self.of_start else found

    def _without_starts(self, signal: FloatArray) -> FloatArray:
        """Do as :func:`without` with the scored samples of all records at once."""
        bases, begins, counts = self._starts
        rows = signal.reshape(len(signal), -1)
        for column in bases.T[:, :, None]:
            with np.errstate(invalid="ignore", over="ignore"):  # it may run away
                shares = np.add.reduceat(column * rows, begins)
            shares[~np.isfinite(shares).all(axis=1)] = 0.0
            rows = rows - column * np.repeat(shares, counts, axis=0)
        return rows.reshape(signal.shape)

    @cached_property
    def _starts(self) -> tuple[FloatArray, NDArray[np.intp], NDArray[np.intp]]:
        """Orthonormal columns of each record, where each begins, and its size.

        Columns of nothing fill up those of records that have fewer; empty records are
        left out.
        """
        own = [orthonormal_of(x) for x in self.of_start if len(x)]
        counts = np.array([len(x) for x in own], dtype=np.intp)
        most = max(x.shape[1] for x in own)
        full = [np.pad(x, ((0, 0), (0, most - x.shape[1]))) for x in own]
        return np.concatenate(full), np.cumsum(counts) - counts, counts

    def about_means(self, values: FloatArray) -> FloatArray:
        """Take the mean of each record off, shape (scored samples,)."""
        about = values.copy()
        for part in self.slices:
            about[part] -= np.mean(values[part])
        return about

    def _lines(self, lengths: tuple[int, ...]) -> list[Line]:
        """Give between which samples of signals of such lengths the scored ones lie."""
        if lengths not in self._known_lines:
            places = [
                p / step for p, step in zip(self.positions, self.apart, strict=True)
            ]
            left = [
                np.minimum(at.astype(np.intp), n - 2)
                for at, n in zip(places, lengths, strict=True)
            ]
            self._known_lines[lengths] = [
                (k, at - k) for k, at in zip(left, places, strict=True)
            ]
        return self._known_lines[lengths]

    @cached_property
    def _known_lines(self) -> dict[tuple[int, ...], list[Line]]:
        return {}


def _between(
    signal: FloatArray, left: NDArray[np.intp], part: FloatArray
) -> FloatArray:
    """Give a signal, shape (n,) or (n, k), at places behind samples of it."""
    if signal.ndim > 1:
        part = part[:, None]
    start = signal[left]
    return np.asarray(start + part * (signal[left + 1] - start))


def orthonormal_of(columns: FloatArray) -> FloatArray:
    """Give orthonormal columns that span others; what is zero everywhere spans nothing.

    Parameters
    ----------
    columns : ndarray, shape (n, k)
    """
    return np.linalg.qr(columns[:, np.any(columns != 0.0, axis=0)])[0]


def without(signal: FloatArray, columns: FloatArray) -> FloatArray:
    """Take off a signal what columns explain of it, by least squares.

    Parameters
    ----------
    signal : ndarray, shape (n,) or (n, k)
    columns : ndarray, shape (n, columns)
    """
    if not columns.shape[1] or not len(signal):
        return signal
    basis = orthonormal_of(columns)
    with np.errstate(invalid="ignore", over="ignore"):  # a signal may run away
        share = basis.T @ signal
    return signal - basis @ share if np.all(np.isfinite(share)) else signal


@dataclass(frozen=True)
class Compared:
    """A record and what a model says of it, in free run from the input alone."""

    record: Record
    simulated: FloatArray
    """Shape (n,). In the unit of the record's output."""

    @property
    def residual(self) -> FloatArray:
        """Measured minus simulated, shape (n,).

        Without what is not known of the first sample does.
        """
        return without(self.record.y - self.simulated, self.record.of_start)


def whole_periods(values: FloatArray, period: int) -> FloatArray:
    """Give the whole periods at the end of signals, one behind the other.

    The first of them holds the way from rest: it is left out, given two others.

    Parameters
    ----------
    values : ndarray, shape (..., n)
    period : int
        Samples of a period, at most n.

    Returns
    -------
    ndarray, shape (..., periods, period)
    """
    count = values.shape[-1] // period
    used = count - 1 if count > 2 else count
    return values[..., -used * period :].reshape(*values.shape[:-1], used, period)
