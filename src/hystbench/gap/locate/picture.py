"""What a picture shows, as data: the page draws it, and curves.json holds it.

Below are those of the residual over the axis of a view: input, rate, time, record.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hystbench.gap.locate.samples import ViewSamples
from hystbench.record import FloatArray
from hystbench.sentences import percent

MOST_POINTS = 200
"""Most points of a line."""

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
class ViewPicture:
    """Panels beside each other, and what they show in words."""

    name: str
    words: str
    panels: tuple[Panel, ...]


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
    """Average neighbours, so that at most :data:`MOST_POINTS` are left."""
    count = len(values[0])
    size = max(1, -(-count // MOST_POINTS))
    return [block_means(each, size) for each in values]


def block_means(values: FloatArray, size: int) -> FloatArray:
    """Average blocks of as many samples each; the last may be shorter."""
    starts = np.arange(0, len(values), size)
    counts = np.diff(np.append(starts, len(values)))
    return np.add.reduceat(values, starts) / counts


def mean_in(edges: FloatArray, at: FloatArray, values: FloatArray) -> FloatArray:
    """Average values between edges; NaN where there are none."""
    held, _ = np.histogram(at, edges)
    total, _ = np.histogram(at, edges, weights=values)
    return np.where(held > 0, total / np.maximum(held, 1), np.nan)


INPUT_CELLS = 40
"""Cells of the picture over the input."""
MAP_COLUMNS = 18
"""Cells of the map along the input, of one width."""
MAP_ROWS = 6
"""Cells along the rate's magnitude, for each sign, of about as many samples each.

Fewer where the input rests."""
LEAST_SAMPLES = 5
"""Samples of a cell that is shown: the mean of fewer is mostly noise."""
MOST_BLOCKS = 25
"""Means of a record over slow time, at most."""


def over_input(samples: ViewSamples) -> ViewPicture:
    """Draw the residual over the input, branch by branch."""
    u, residual = samples.input, samples.residual
    top = max(float(u.max()), u.min() + 1e-300)
    edges = np.linspace(float(u.min()), top, INPUT_CELLS + 1)
    middle = 0.5 * (edges[1:] + edges[:-1])
    lines = [
        series(role, middle, mean_in(edges, u[way], residual[way]), role)
        for role, sign in (("rising", 1), ("falling", -1))
        for way in [samples.direction == sign]
    ]
    rms = series("noise", middle, np.sqrt(mean_in(edges, u, residual**2)), "rms")
    given, made = samples.units
    panel = Panel(Axis("input", given), Axis("mean residual", made), (*lines, rms))
    return ViewPicture(
        "over-input", "Mean residual over the input, by branch", (panel,)
    )


def over_plane(samples: ViewSamples) -> ViewPicture | None:
    """Average the residual over cells of the input and of its rate together.

    What depends on both, as a loop that widens with rate and amplitude, shows neither
    over the input alone nor over the rate alone. The share that is told is that of the
    gap's power that the cells' means hold.

    Returns
    -------
    ViewPicture, optional
        None where the input never moves.
    """
    u, residual = samples.input, samples.residual
    rows = rate_edges(samples.speed)
    if rows is None:
        return None
    columns = np.linspace(float(u.min()), float(u.max()), MAP_COLUMNS + 1)
    at, edges = (u, samples.speed), (columns, rows)
    held, _, _ = np.histogram2d(*at, edges)
    total, _, _ = np.histogram2d(*at, edges, weights=residual)
    enough = held >= LEAST_SAMPLES
    mean = np.where(enough, total / np.maximum(held, 1), np.nan)
    explained = float(np.sum(held * np.nan_to_num(mean) ** 2)) / len(u)
    share = samples.share(explained, int(enough.sum()))
    given, made = samples.units
    shown = Axis("measured − simulated", made)  # noqa: RUF001  (a minus sign)
    values = [listed(row) for row in mean.T]
    panel = Panel(
        Axis("input", given),
        Axis("rate of the input", f"{given}/s"),
        title="mean residual by the input and its rate",
        cells=Cells(listed(columns), listed(rows), values, shown),
    )
    words = (
        "How to read it: a cell shows by how much the measurement lies above (red) or "
        "below (blue) the simulation, in the mean, where the input had that value and "
        "moved at that rate; above zero it rises, below it falls; grey cells have few "
        f"samples. These cells hold {percent(share)} of the gap"
    )
    return ViewPicture("over-plane", words, (panel,))


def rate_edges(speed: FloatArray) -> FloatArray | None:
    """Give edges that are alike for both signs; fast records do not hide slow ones."""
    size = np.abs(speed)
    found = np.unique(np.quantile(size, np.linspace(0, 1, MAP_ROWS + 1)[1:]))
    found = found[found > 0]
    return np.concatenate([-found[::-1], [0.0], found]) if len(found) else None


def over_time(samples: ViewSamples) -> ViewPicture:
    """Draw the mean residual over blocks of whole periods, record behind record."""
    lines, start = [], 0.0
    for k, item in enumerate(samples.compared):
        residual, dt = item.residual[item.record.past :], item.record.dt
        n = len(residual)
        main = float(samples.main_frequencies[k])
        period = item.record.period_samples or round(1 / max(main * dt, 1 / n))
        # Whole periods, so that what repeats cancels alike in every block.
        size = min(n, max(1, period) * max(1, -(-n // (MOST_BLOCKS * max(1, period)))))
        means = block_means(residual[: n // size * size], size)
        at = start + (np.arange(len(means)) + 0.5) * size * dt
        lines.append(series(("first", "second")[k % 2], at, means, item.record.name))
        start += len(means) * size * dt
    panel = Panel(
        Axis("time, record behind record", "s"),
        Axis("mean residual", samples.units[1]),
        tuple(lines),
        labelled_above=True,
    )
    words = "Mean of the residual over slow time, record behind record"
    return ViewPicture("slow", words, (panel,))


def over_records(names: list[str], shares: FloatArray) -> ViewPicture:
    """Draw a bar a record."""
    bars = Bars(names, listed(100 * shares))
    panel = Panel(Axis("share of the gap's power", "%"), Axis("record"), bars=bars)
    return ViewPicture(
        "records", "Share of the gap's power in each fit record", (panel,)
    )
