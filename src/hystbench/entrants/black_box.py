"""What the black boxes share: features, the residual they learn, and which is best."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from hystbench.entrants.task import Given, Predict
from hystbench.record import FloatArray, Record

#: A prediction that runs away is kept within so many times the measured range.
RUNAWAY = 10.0
#: Learns from records how to predict others.
Learn = Callable[[Sequence[Record]], Predict]


class Scale(NamedTuple):
    """Mean and spread of each feature."""

    mean: FloatArray
    spread: FloatArray


def features(given: Given, record: Record) -> FloatArray:
    """Input, its rate, the base's output and its rate, and time; shape (n, 5)."""
    base = given.base(record)
    return np.stack(
        [
            record.u,
            np.gradient(record.u, record.dt),
            base,
            np.gradient(base, record.dt),
            record.time,
        ],
        axis=1,
    )


def residual(given: Given, record: Record) -> FloatArray:
    """Measured minus simulated."""
    return np.asarray(record.y - given.base(record))


def scaled(x: FloatArray, scale: Scale | None = None) -> tuple[FloatArray, Scale]:
    """Bring features to mean zero and spread one, or to a scale found before."""
    if scale is None:
        spread = np.std(x, axis=0)
        scale = Scale(np.mean(x, axis=0), np.where(spread > 0, spread, 1.0))
    return (x - scale.mean) / scale.spread, scale


def kept(prediction: FloatArray, record: Record) -> FloatArray:
    """Keep a prediction finite: where it ran away it stays at the limit, and scores so.

    Parameters
    ----------
    prediction : ndarray, shape (n,)
    record : Record
    """
    limit = RUNAWAY * float(np.abs(record.y).max())
    return np.clip(np.nan_to_num(prediction, nan=limit), -limit, limit)


def best(given: Given, ways: Sequence[Learn]) -> Predict:
    """Learn from all fit records in the way that does best where it did not learn.

    Every other fit record is left out, then the others; where no way comes nearer to
    them than the base, the base is left as it is. What runs free can run away, and its
    fit does not tell.

    Parameters
    ----------
    given : Given
    ways : sequence of callable
    """
    halves = given.fit[::2], given.fit[1::2]
    folds = [halves, halves[::-1]] if halves[1] else [(given.fit, given.fit)]

    def error(learn: Learn) -> float:
        return sum(
            float(np.sum((record.y - predict(record)) ** 2))
            for learned, others in folds
            for predict in [learn(learned)]
            for record in others
        )

    return min([lambda _: given.base, *ways], key=error)(given.fit)
