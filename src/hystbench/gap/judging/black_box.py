"""A black box of the residual, judged on folds of the fit records.

It is judged on blocks of every record; an effect has to pay on whole records where
there are three or more. So the black box has the easier task: of sines of one frequency
a record it cannot guess the next frequency. It names nothing. Where it explains clearly
more than the named effects, something is there that the vocabulary has no name for.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from hystbench.errors import InputError
from hystbench.gap.judging.regressors import Columns, Family
from hystbench.gap.judging.ridge import Moments
from hystbench.gap.records.folds import Fold, make_folds
from hystbench.gap.records.residual import Compared
from hystbench.record import FloatArray, Mask, Record

#: Rows of all records together that are fitted: neighbouring samples say the same.
ROWS = 6000
#: Ridge penalties to choose from, per row of standardised columns; the largest leaves
#: next to nothing, where nothing carries over from one fold to another.
PENALTIES = np.geomspace(1e-7, 1e3, 6)
#: Families of columns that are left out, one choice after another.
LEFT_OUT: tuple[tuple[Family, ...], ...] = ((), ("modes",), ("modes", "landmarks"))
#: Penalty of a column that is left out.
SHUT = 1e9
#: Amplitude or rate beyond the training records' largest by more is outside.
BEYOND = 1.02


@dataclass(frozen=True, repr=False)
class BlackBox:
    """Nonlinear finite-impulse-response model of the residual, in free run.

    Columns: lags, low-passes and play operators of input and simulated output, the
    products of a few signals and radial basis functions of them. Weights by ridge
    regression; their penalty, and which families of columns take part, is chosen for a
    fold on the other folds.

    Attributes
    ----------
    explained_on_folds : float or None
        Share of the residual's power above the floor that is gone on samples held
        out from the fit; below zero where the black box makes it worse; None where
        there is no power above the floor.
    explained_by_record : dict of str to float or None
        The same, record by record.
    power_on_folds : float
        Mean square of what is left on the held-out samples.

    References
    ----------
    C. K. I. Williams, M. Seeger, "Using the Nystroem method to speed up kernel
    machines", Advances in Neural Information Processing Systems 13, 2001.
    """

    columns: Columns
    weights: FloatArray
    explained_on_folds: float | None
    explained_by_record: dict[str, float | None]
    power_on_folds: float
    largest_input: tuple[float, float]
    largest_rate: float

    @classmethod
    def fit(
        cls,
        compared: Sequence[Compared],
        folds: Sequence[Fold],
        floor_rms: float | Sequence[float] = 0.0,
    ) -> BlackBox:
        """Fit to the residuals of the fit records.

        Parameters
        ----------
        compared : sequence of Compared
        folds : sequence of Fold
            Of the same records, in the same order.
        floor_rms : float or sequence of float
            Noise floor of all records, or of each, in output units.

        Raises
        ------
        InputError
            If folds and records do not match.
        """
        _check(compared, folds)
        rows = _rows([item.record for item in compared])
        columns, table = Columns.learn(compared, rows)
        target = np.concatenate(
            [item.residual[row] for item, row in zip(compared, rows, strict=True)]
        )
        train = _joined([fold.train for fold in folds], rows)
        judged = _joined([fold.validation for fold in folds], rows)
        moments = Moments.of(table, target, train)

        choices = _choices(columns.families)

        # A fold's penalties are those that do best on the other folds: its own samples
        # choose neither weights nor penalties by how well they are predicted.
        solved = [moments.solve(k, choices) for k in range(len(folds))]
        errors = np.array(
            [
                _mean_squares(table, target, held, weights)
                for held, weights in zip(judged, solved, strict=True)
            ]
        )
        predicted = np.zeros_like(target)
        for k, held in enumerate(judged):
            best = int(np.argmin(np.delete(errors, k, axis=0).mean(axis=0)))
            predicted[held] = table[held] @ solved[k][best]
        best = int(np.argmin(errors.mean(axis=0)))
        (weights,) = moments.solve(None, [choices[best]])

        floor = np.broadcast_to(np.square(floor_rms), len(compared))
        left = np.square(target - predicted)
        ends = np.cumsum([len(row) for row in rows])[:-1]
        before = [float(each.mean()) for each in np.split(np.square(target), ends)]
        after = [float(each.mean()) for each in np.split(left, ends)]
        share = np.array([len(item.record) for item in compared], dtype=float)
        share /= share.sum()
        inputs = [item.record.u for item in compared]
        return cls(
            columns,
            weights,
            _explained(*(float(share @ each) for each in (before, after, floor))),
            {
                item.record.name: _explained(*powers)
                for item, *powers in zip(compared, before, after, floor, strict=True)
            },
            float(share @ after),
            (min(float(u.min()) for u in inputs), max(float(u.max()) for u in inputs)),
            max(_fastest(item.record) for item in compared),
        )

    def predict(self, record: Record, simulated: FloatArray) -> FloatArray:
        """Predict the residual from the input and the simulated output alone.

        Returns
        -------
        ndarray, shape (n,)
            In the unit of the output.
        """
        return self.columns.weighed(Compared(record, simulated), self.weights)

    def outside(self, record: Record) -> tuple[str, ...]:
        """Tell in what a record lies outside the records that were fitted.

        Returns
        -------
        tuple of {"amplitude", "rate"}
            Empty where the black box interpolates.
        """
        low, high = self.largest_input
        middle, half = (low + high) / 2, (high - low) / 2
        ways = []
        if float(np.abs(record.u - middle).max()) > BEYOND * half:
            ways.append("amplitude")
        if _fastest(record) > BEYOND * self.largest_rate:
            ways.append("rate")
        return tuple(ways)


def _check(compared: Sequence[Compared], folds: Sequence[Fold]) -> None:
    lengths = [len(item.record) for item in compared]
    for fold in folds:
        if [len(mask) for mask in fold.validation] != lengths:
            raise InputError(
                f"folds of {len(fold.validation)} records do not fit these "
                f"{len(compared)} records; expected those of make_folds"
            )


def _choices(families: Sequence[Family]) -> list[FloatArray]:
    """Penalties of the columns, per row: every size with every family left out."""
    choices = []
    for left_out in LEFT_OUT:
        shut = np.array([family in left_out for family in families])
        for penalty in PENALTIES:
            ridge = np.where(shut, SHUT, penalty)
            ridge[-1] = PENALTIES[0]  # the constant column is hardly held back
            choices.append(ridge)
    return choices


def _rows(records: Sequence[Record]) -> list[Any]:
    """Choose measured rows, one at random in each of equal stretches of a record.

    A regular step could beat with a period and miss parts of the loop.
    """
    random = np.random.default_rng(0)
    measured = [np.flatnonzero(record.counted) for record in records]
    stretch = max(1.0, sum(map(len, measured)) / ROWS)
    rows = []
    for places in measured:
        length = len(places)
        count = max(1, round(length / stretch))
        at = (np.arange(count) + random.random(count)) * (length / count)
        rows.append(places[np.unique(np.minimum(at.astype(np.intp), length - 1))])
    return rows


def _joined(masks: Sequence[Sequence[Mask]], rows: Sequence[Any]) -> Any:
    """Masks of all records' chosen rows, shape (folds, rows)."""
    return np.stack(
        [
            np.concatenate([mask[row] for mask, row in zip(fold, rows, strict=True)])
            for fold in masks
        ]
    )


def _mean_squares(
    table: FloatArray, target: FloatArray, held: Any, weights: list[FloatArray]
) -> FloatArray:
    left = target[held, None] - table[held] @ np.column_stack(weights)
    return np.asarray(np.square(left).mean(axis=0))


def _explained(before: float, after: float, floor: float) -> float | None:
    above = before - floor
    return float((before - after) / above) if above > 0 else None


def _fastest(record: Record) -> float:
    """Largest rate of the input, in its unit per second; a lone jump does not count."""
    return float(np.quantile(np.abs(np.gradient(record.u, record.dt)), 0.995))


def black_box(compared: Sequence[Compared], floor_rms: float) -> BlackBox:
    """Fit the black box to what the base leaves on the fit records."""
    folds = make_folds([item.record for item in compared], whole=False)
    return BlackBox.fit(compared, folds, floor_rms)
