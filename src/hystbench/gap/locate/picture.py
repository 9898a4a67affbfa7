"""What a picture shows, as data: the page draws it, and curves.json holds it."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hystbench.record import FloatArray

POINTS = 200
"""Of a line, at most."""

Number = float | None
"""None where there is nothing to show."""


@dataclass(frozen=True)
class Axis:
    """Name, unit and scale of an axis."""

    name: str
    unit: str = ""
    logarithmic: bool = False


@dataclass(frozen=True)
class Series:
    """One line of a panel, with standard errors or without.

    Its role is what it is: it decides how the page draws it (``LOOKS`` there).
    """

    role: str
    x: list[Number]
    y: list[Number]
    label: str = ""
    error: list[Number] | None = None


@dataclass(frozen=True)
class Cells:
    """Values over a plane, between the edges of columns and rows."""

    columns: list[Number]
    rows: list[Number]
    values: list[list[Number]]
    axis: Axis


@dataclass(frozen=True)
class Bars:
    """A value for each name."""

    names: list[str]
    values: list[Number]


@dataclass(frozen=True)
class Panel:
    """Axes with lines, with cells or with bars.

    Where lines stand behind each other, each has its label above it.
    """

    x: Axis
    y: Axis
    series: tuple[Series, ...] = ()
    title: str = ""
    cells: Cells | None = None
    bars: Bars | None = None
    labelled_above: bool = False


@dataclass(frozen=True)
class Picture:
    """Panels beside each other, and what they show in words."""

    name: str
    words: str
    panels: tuple[Panel, ...]

    def to_mapping(self) -> dict[str, Any]:
        """Give what curves.json holds."""
        return asdict(self)


FREQUENCY = Axis("frequency", "Hz", logarithmic=True)


def series(
    role: str, x: ArrayLike, y: ArrayLike, label: str = "", error: Any = None
) -> Series:
    """Give a line from arrays."""
    errors = None if error is None else listed(error)
    return Series(role, listed(x), listed(y), label, errors)


def listed(values: ArrayLike) -> list[Number]:
    """Give plain floats with as many digits as a picture shows; None for NaN."""
    return [
        None if np.isnan(value) else float(f"{value:.6g}")
        for value in np.asarray(values, dtype=np.float64)
    ]


def thinned(*values: FloatArray) -> list[FloatArray]:
    """Average neighbours, so that at most :data:`POINTS` are left."""
    count = len(values[0])
    size = max(1, -(-count // POINTS))
    starts = np.arange(0, count, size)
    held = np.diff(np.append(starts, count))
    return [np.add.reduceat(each, starts) / held for each in values]


def mean_in(edges: FloatArray, at: FloatArray, values: FloatArray) -> FloatArray:
    """Average values between edges; NaN where there are none."""
    held, _ = np.histogram(at, edges)
    total, _ = np.histogram(at, edges, weights=values)
    return np.where(held > 0, total / np.maximum(held, 1), np.nan)
