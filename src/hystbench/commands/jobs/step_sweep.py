"""``hystbench job step-sweep``: how far each step size can go.

The measured edge stands beside Eq. 19's bound. All step sizes of a filter are raised
together from a tenth of the configured ones. The edge is the least at which the filter
is of no use: its error is as large as the displacement, or it diverges.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hystbench.adaptive import make_filter, steps_of, with_steps
from hystbench.compare.beside import EDGE_COLUMNS, Edge
from hystbench.compare.rows import four_digits, names_of, write_fields
from hystbench.filters import AdaptiveFilter, run_many
from hystbench.metrics import (
    mean_square_error,
    relative_error,
    smoothed_squared_error,
)
from hystbench.options import In, Json, Out, Settings, command
from hystbench.record import FloatArray, Record, load_record
from hystbench.twins.runs import filter_jobs

BATCH = 32
"""Runs held in memory at a time."""
WELL_BELOW = 0.5
"""Convergence times are compared up to this part of the edge."""
CONVERGED = 0.1
"""Relative error at which a filter counts as converged: 20 dB down."""


@dataclass(frozen=True)
class Point:
    """A filter on a signal with one factor on its step sizes."""

    signal: str
    model: str
    factor: float
    mu: float
    mse: float
    re: float
    convergence_s: float | None


@command
def step_sweep(
    records: tuple[In, ...],
    *,
    identified: Json | None = None,
    settings: Settings,
    edges: Out,
    points: Out,
) -> None:
    """Raise each filter's step sizes on RECORDS up to their edge."""
    steps = _factors(settings["sweep"])
    found: list[Edge] = []
    run: list[Point] = []
    for record in map(load_record, records):
        for model, job in filter_jobs(settings).items():
            adaptive = make_filter(model, job, record, identified)
            own = _run(adaptive, record, steps, job["smoothing_fraction"])
            run += own
            found.append(_edge(adaptive, record, own))
    write_fields(edges, EDGE_COLUMNS, found, four_digits)
    write_fields(points, names_of(Point), run, four_digits)


def _factors(settings: Settings) -> list[float]:
    """Give the factors on the step sizes, rising by one ratio."""
    low, high, ratio = (settings[key] for key in ("from", "to", "ratio"))
    count = math.ceil(math.log(high / low) / math.log(ratio)) + 1
    return [float(f) for f in low * ratio ** np.arange(count)]


def _run(
    adaptive: AdaptiveFilter, record: Record, steps: Sequence[float], smoothing: float
) -> list[Point]:
    usual = steps_of(adaptive)
    found: list[Point] = []
    for start in range(0, len(steps), BATCH):
        batch = steps[start : start + BATCH]
        filters = [
            with_steps(adaptive, {name: factor * mu for name, mu in usual.items()})
            for factor in batch
        ]
        results = run_many(((f, record.u, record.y) for f in filters), workers=1)
        for factor, result in zip(batch, results, strict=True):
            place = (record.name, adaptive.name, factor, factor * adaptive.step_size)
            if result.diverged_at is not None:
                found.append(Point(*place, math.inf, math.inf, None))
                continue
            error = result.error
            time = _convergence_time(error, record, smoothing)
            mse, re = mean_square_error(error), relative_error(error, record.y)
            found.append(Point(*place, mse, re, time))
        # Far beyond the edge nothing more is learned.
        if all(point.re >= 1 for point in found[-len(batch) :]):
            break
    return found


def _convergence_time(
    error: FloatArray, record: Record, smoothing_fraction: float
) -> float | None:
    """Time (s) at which the smoothed error first is small; None where it never is."""
    window = max(1, round(smoothing_fraction * len(record)))
    smoothed = smoothed_squared_error(error, window)
    small = smoothed <= CONVERGED**2 * np.mean(record.y**2)
    return float(np.argmax(small) * record.dt) if small.any() else None


def _trend(points: Sequence[Point]) -> float | None:
    """Rank correlation of the convergence time with mu; None where it is one time."""
    timed = [(p.mu, p.convergence_s) for p in points if p.convergence_s is not None]
    if len({time for _, time in timed}) < 2:
        return None
    # Equal times have equal ranks.
    mu, times = (np.unique(v, return_inverse=True)[1] for v in zip(*timed, strict=True))
    return float(np.corrcoef(mu, times)[0, 1])


def _edge(adaptive: AdaptiveFilter, record: Record, points: Sequence[Point]) -> Edge:
    beyond = [point for point in points if point.re >= 1]
    bounds = adaptive.step_bounds(record.u)
    # As a share of Eq. 19's bound, all parts of R together: mu1 tr R1 + mu2 tr R2.
    share = sum(step / bounds[key] for key, step in steps_of(adaptive).items())
    correction = adaptive.correction(adaptive.largest_power(record.u))
    edge = beyond[0].mu if beyond else None
    below = [p for p in points if edge is not None and p.mu <= WELL_BELOW * edge]
    return Edge(
        signal=record.name,
        model=adaptive.name,
        mu=adaptive.step_size,
        largest_correction=correction,
        at_trace=adaptive.step_size / share,
        at_power=2 * adaptive.step_size / correction,
        edge=edge,
        speed_trend=_trend(below),
    )
