"""Unknowns between bounds, and the search for their best values."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from hystbench.record import FloatArray

Tell = Callable[[str], None]
"""Told one line of progress at a time."""
Values = Mapping[str, float]
"""Values of unknowns by name."""


@dataclass(frozen=True)
class Unknown:
    """A number that a search may choose.

    Parameters
    ----------
    name, unit : str
    low, high : float
        Bounds.
    logarithmic : bool
        Whether the search moves in the logarithm.
    start : float
        Where a search begins that knows a good place.
    meaning : str
        What it is, and why the bounds.
    """

    name: str
    unit: str
    low: float
    high: float
    logarithmic: bool = False
    start: float = 0.0
    meaning: str = ""

    def value(self, place: float) -> float:
        """Give the value at a place from 0 to 1 between the bounds."""
        if self.logarithmic:
            return float(self.low * (self.high / self.low) ** place)
        return self.low + place * (self.high - self.low)

    def place(self, value: float) -> float:
        """Give the place of a value: the inverse of :meth:`value`."""
        if self.logarithmic:
            return float(np.log(value / self.low) / np.log(self.high / self.low))
        return (value - self.low) / (self.high - self.low)


@dataclass(frozen=True)
class Fit:
    """What a search found.

    Parameters
    ----------
    values : dict of str to float
        Values of the unknowns by name.
    cost : float
        Half the sum of squares of the residuals.
    places : sequence of float
        The values as a point in the unit cube of the bounds, to the last digit.
    """

    values: dict[str, float]
    cost: float
    places: Sequence[float] = ()


def to_point(unknowns: Sequence[Unknown], values: Values) -> FloatArray:
    """Place values in the unit cube of the bounds."""
    return np.array([item.place(values[item.name]) for item in unknowns])


def to_values(unknowns: Sequence[Unknown], point: FloatArray) -> dict[str, float]:
    """Give the values of a point in the unit cube."""
    pairs = zip(unknowns, point, strict=True)
    return {item.name: item.value(float(place)) for item, place in pairs}


def descend(
    residuals: Callable[[dict[str, float]], FloatArray],
    unknowns: Sequence[Unknown],
    point: FloatArray,
    evaluations: int,
    *,
    edge: float = 1e-6,
    **options: Any,
) -> Fit:
    """Go down from a point by bounded least squares (trust region reflective).

    Parameters
    ----------
    residuals : callable
        Residuals of some values, shape (n,).
    unknowns : sequence of Unknown
    point : ndarray, shape (len(unknowns),)
        Where to start, in the unit cube of the bounds.
    evaluations : int
        At most so many, those for slopes not counted.
    edge : float
        How far inside the bounds the start is moved.
    **options
        Of :func:`scipy.optimize.least_squares`: how slopes are taken, and scales.
    """
    from scipy.optimize import least_squares  # late: takes a second

    result = least_squares(
        lambda moved: residuals(to_values(unknowns, moved)),
        np.clip(point, edge, 1 - edge),
        bounds=(0.0, 1.0),
        max_nfev=evaluations,
        **options,
    )
    places = result.x.tolist()
    return Fit(to_values(unknowns, result.x), float(result.cost), places)
