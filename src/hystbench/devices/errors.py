"""Errors of the paper's models on the hold-out records of one measured dataset.

Two questions, never mixed. *Tracking* is the paper's: a filter predicts each output
with weights that have learned from all outputs before it. *Simulation* is that of the
published benchmarks: everything is fitted to the fit records, then fixed, and the
measured output is not seen any more.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any, Literal

import numpy as np

from hystbench.adaptive import make_filter, with_fraction_of_bound, with_steps
from hystbench.dataset import Dataset
from hystbench.filters import MOST_CORRECTION, AdaptiveFilter, run_many
from hystbench.metrics import mean_square_error
from hystbench.rdgpi.fit import identify_rdgpi
from hystbench.record import FloatArray, Record
from hystbench.slow_loop import identify_slow_loop

Question = Literal["tracking", "simulation"]

LAST = "last-output"
"""No model: what tracks the output by repeating it."""

BATCH = 32
"""Runs held in memory at a time."""
PENALTIES = (1e-9, 1e-7, 1e-5, 1e-3, 1e-1)
"""Charges for the square of a weight, in units of the mean square of its own column."""
TRAINED = 2 / 3
"""Part of each fit record to which weights are fitted while a charge is chosen."""


@dataclass(frozen=True)
class DeviceError:
    """Error of one model on all hold-out records of a dataset.

    Parameters
    ----------
    dataset, model : str
    question : {"tracking", "simulation"}
    how : str
        What was chosen, and how.
    rms : float
        Of the error over all samples of the hold-out records, in the output's unit;
        infinite where a filter diverged.
    relative : float
        The same over the RMS of the output.
    unit : str
    """

    dataset: str
    model: str
    question: Question
    how: str
    rms: float
    relative: float
    unit: str


def device_errors(dataset: Dataset, settings: Mapping[str, Any]) -> list[DeviceError]:
    """Run the paper's five models on a dataset.

    Parameters
    ----------
    dataset : Dataset
        With fit and hold-out records.
    settings : mapping
        ``filters``: those of each filter's job on measured records; ``fractions`` of
        Eq. 19's bound among which each filter takes its own best on the fit records;
        ``constant_tap``; ``identification`` and ``rdgpi`` as for those jobs.
    """
    records = [dataset.read(name) for name in dataset.record_files]
    fit = [record for record in records if record.use == "fit"]
    held = [record for record in records if record.use == "hold-out"]
    slow = next(item for item in fit if item.name == dataset.identification)
    found = identify_slow_loop(slow, settings["identification"])
    square = np.concatenate([record.y**2 for record in held]).mean()

    def error(
        model: str, question: Question, how: str, errors: Sequence[FloatArray] | None
    ) -> DeviceError:
        rms = math.inf
        if errors is not None:
            rms = float(np.sqrt(np.concatenate([e**2 for e in errors]).mean()))
        unit = held[0].output.unit
        relative = rms / math.sqrt(square)
        return DeviceError(dataset.name, model, question, how, rms, relative, unit)

    # Who says that nothing changes from one sample to the next learns nothing.
    steps = [np.diff(record.y, prepend=0.0) for record in held]
    rows = [error(LAST, "tracking", "says the output before", steps)]
    for model, job in settings["filters"].items():

        def made(job: Mapping[str, Any], record: Record, model: str = model) -> Any:
            return make_filter(model, job, record, found.to_dict())

        share = job["fraction_of_bound"]
        plain = [made(job, record) for record in held]
        how = f"{share:g} of the bound of Eq. 19"
        rows.append(error(model, "tracking", how, tracked(plain, held)))
        widest = max(fit, key=lambda record: float(np.abs(record.u).max()))
        for tap in (0.0, settings["constant_tap"]):
            own = made({**job, "constant_tap": tap}, widest)
            parts = best_fractions(own, fit, held, settings["fractions"])
            best = [with_fraction_of_bound(own, record.u, parts) for record in held]
            how = "its own best step" + ", constant tap" * bool(tap)
            rows.append(error(model, "tracking", how, tracked(best, held)))
        weights = fixed_weights(own, fit)
        left = [record.y - output(own, record, weights) for record in held]
        rows.append(error(model, "simulation", "fixed weights", left))
    rate = identify_rdgpi(fit, **settings["rdgpi"]).model
    left = [record.y - rate.simulate(record.u, record.dt) for record in held]
    rows.append(error("rdgpi", "simulation", "fitted to the fit records", left))
    return rows


def tracked(
    filters: Sequence[AdaptiveFilter], records: Sequence[Record]
) -> list[FloatArray] | None:
    """Give a priori errors of filters that begin each record with zero weights.

    None where one diverges.
    """
    runs = [item.run(r.u, r.y) for item, r in zip(filters, records, strict=True)]
    if any(run.diverged_at is not None for run in runs):
        return None
    return [run.error for run in runs]


def best_fractions(
    adaptive: AdaptiveFilter,
    fit: Sequence[Record],
    held: Sequence[Record],
    fractions: Sequence[float],
) -> dict[str, float]:
    """Give the step sizes with which a filter tracks the fit records best.

    Those are left out with which one update corrects more of an error than
    :data:`hystbench.filters.MOST_CORRECTION` on the input of any record: there the
    filter is about to be unstable. Of the hold-out records only inputs are looked at.

    Returns
    -------
    dict of str to float
        As fractions of the bound of Eq. 19 on each record's own input, the same ones
        for all: those of the least geometric mean of the MSE over the fit records, each
        begun with zero weights.
    """
    names = adaptive.step_sizes
    grid = product(sorted(fractions), repeat=len(names))
    choices = [dict(zip(names, parts, strict=True)) for parts in grid]
    steady = np.ones(len(choices), dtype=bool)
    errors = []
    for place, record in enumerate((*fit, *held)):
        bounds = adaptive.step_bounds(record.u)
        power = adaptive.largest_power(record.u)
        filters = [
            with_steps(adaptive, {name: parts[name] * bounds[name] for name in names})
            for parts in choices
        ]
        steady &= [each.correction(power) < MOST_CORRECTION for each in filters]
        if place < len(fit):
            errors.append(_mean_squares(filters, record))
    with np.errstate(divide="ignore"):
        mean = np.exp(np.log(np.array(errors).T.copy()).mean(axis=-1))
    return choices[int(np.argmin(np.where(steady, mean, math.inf)))]


def _mean_squares(filters: Sequence[AdaptiveFilter], record: Record) -> list[float]:
    """Run filters on a record; infinite where one diverged."""
    errors = []
    for start in range(0, len(filters), BATCH):
        batch = ((f, record.u, record.y) for f in filters[start : start + BATCH])
        for result in run_many(batch, workers=1):
            finite = result.diverged_at is None
            errors.append(mean_square_error(result.error) if finite else math.inf)
    return errors


def fixed_weights(adaptive: AdaptiveFilter, fit: Sequence[Record]) -> FloatArray:
    """Fit weights to records by least squares, once for all samples.

    The square of each weight is charged; the charge is the one with which weights
    fitted to the first two thirds of each record do best on its last third.

    Returns
    -------
    ndarray, shape (size,)
    """
    first = _Equations.of(adaptive, fit, 0.0, TRAINED)
    last = _Equations.of(adaptive, fit, TRAINED, 1.0)
    judged = [last.left(first.solved(charge)) for charge in PENALTIES]
    return (first + last).solved(PENALTIES[int(np.argmin(judged))])


def output(adaptive: AdaptiveFilter, record: Record, weights: FloatArray) -> FloatArray:
    """Simulate a filter with fixed weights: the measured output is not seen."""
    return np.concatenate([rows @ weights for rows in adaptive.rows(record.u)])


@dataclass(frozen=True)
class _Equations:
    """Normal equations: sums of ``H H'``, ``d H`` and ``d^2``."""

    squares: FloatArray
    products: FloatArray
    power: float

    @classmethod
    def of(
        cls, adaptive: AdaptiveFilter, fit: Sequence[Record], low: float, high: float
    ) -> _Equations:
        """Sum over a part of each record."""
        size = adaptive.size
        squares, products, power = np.zeros((size, size)), np.zeros(size), 0.0
        for record in fit:
            for h, d in _paired(adaptive, record, low, high):
                squares += h.T @ h
                products += h.T @ d
                power += float(d @ d)
        return cls(squares, products, power)

    def __add__(self, other: _Equations) -> _Equations:
        return _Equations(
            self.squares + other.squares,
            self.products + other.products,
            self.power + other.power,
        )

    def solved(self, charge: float) -> FloatArray:
        """Give the weights; columns are brought to one size first."""
        size = np.sqrt(np.maximum(np.diag(self.squares), np.finfo(np.float64).tiny))
        scaled = self.squares / np.outer(size, size) + charge * np.eye(len(size))
        return np.asarray(np.linalg.solve(scaled, self.products / size) / size)

    def left(self, weights: FloatArray) -> float:
        """Sum of squares that weights leave."""
        fitted = weights @ self.squares @ weights - 2 * self.products @ weights
        return float(fitted) + self.power


def _paired(
    adaptive: AdaptiveFilter, record: Record, low: float, high: float
) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Give regressors and outputs of a part of a record, some samples at a time."""
    start, stop, done = round(low * len(record)), round(high * len(record)), 0
    for rows in adaptive.rows(record.u):
        part = slice(max(start - done, 0), max(stop - done, 0))
        end = done + len(rows)
        yield rows[part], record.y[done:end][part]
        done = end
