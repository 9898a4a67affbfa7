"""Ridge regression on many folds and penalties from one pass over the rows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hystbench.record import FloatArray


@dataclass(frozen=True)
class Moments:
    """Normal equations of the rows that share the folds which they train.

    One pass over the rows serves every fold and penalty.
    """

    patterns: FloatArray  # shape (patterns, folds), 1 where the rows train the fold
    counts: FloatArray  # shape (patterns,)
    square: FloatArray  # shape (patterns, m, m)
    mixed: FloatArray  # shape (patterns, m)

    @classmethod
    def of(cls, table: FloatArray, target: FloatArray, train: FloatArray) -> Moments:
        """Gather the normal equations.

        Parameters
        ----------
        table : ndarray, shape (rows, m)
        target : ndarray, shape (rows,)
        train : ndarray of bool, shape (folds, rows)
            Which rows fit each fold.
        """
        patterns, which = np.unique(train.T, axis=0, return_inverse=True)
        groups = [
            np.flatnonzero(which.ravel() == each) for each in range(len(patterns))
        ]
        return cls(
            patterns.astype(np.float64),
            np.array([len(group) for group in groups], dtype=np.float64),
            np.stack([table[group].T @ table[group] for group in groups]),
            np.stack([table[group].T @ target[group] for group in groups]),
        )

    def solve(
        self, fold: int | None, choices: Sequence[FloatArray]
    ) -> list[FloatArray]:
        """Find the weights.

        Parameters
        ----------
        fold : int or None
            Fitted to the rows that train this fold, or to all.
        choices : sequence of ndarray, shape (m,) each
            Penalties of the columns, per row, above zero.

        Returns
        -------
        list of ndarray, shape (m,) each
            One a choice: the least ``|target - table w|^2 + rows * penalty . w^2``.
        """
        from scipy.linalg import cho_factor, cho_solve

        used = slice(None) if fold is None else self.patterns[:, fold] > 0
        square, mixed = self.square[used].sum(axis=0), self.mixed[used].sum(axis=0)
        rows = self.counts[used].sum()
        return [
            cho_solve(cho_factor(square + np.diag(rows * ridge)), mixed)
            for ridge in choices
        ]
