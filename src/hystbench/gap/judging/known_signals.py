"""Known signals that tell what sort of thing a residual is, though not its name.

Each group answers one question on what named effects leave: does the strength change
from record to record, is there memory of another kind, a curve of another kind? The
columns are made of the input, of the base's output and of that of the model with its
effects; time constants come from the records alone.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from hystbench.blocks.linear import low_pass
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.records.free_mass import runs
from hystbench.operators import play
from hystbench.record import FloatArray, Record

SLOW_COSINES = 3
"""Cosines over a record by which a strength may change in it."""
PATH_COSINES = 5
"""Cosines over a record that a path of its own may have."""
WALK_COSINES = 100
"""Cosines of a random walk over a run: all but 0.6 % of its power."""
WALKS_COSINES = 1000
"""Most random walks of all runs together: many runs have fewer each."""
TIMES = 5
"""Time constants of low-passes, from the shortest step on, and of slow averages."""
DELAYS = (1, 2, 4, 8, 16)
"""Shortest sampling intervals."""
REACH = 300.0
"""Longest low-pass of the dynamics, in shortest sampling intervals."""
SLOWEST = 0.01
"""Shortest slow average, in longest records."""
THRESHOLDS = (0.1, 0.3, 0.5, 0.7)
"""Thresholds of plays, as shares of the input's largest size."""

PATH = "drift"
"""The effect that gives every record a slow path of its own."""

SLOW_POWER = "slow power"
"""The group of slow averages of the squared input: what heat does."""

Columns = list[FloatArray]
"""Columns of one record, shape (n,) each."""


def generic_groups(base: ModelState, state: ModelState) -> dict[str, FloatArray]:
    """Give the groups of columns, each on the scored samples.

    Parameters
    ----------
    base : ModelState
        The model without effects.
    state : ModelState
        With the named effects.

    Returns
    -------
    dict of str to ndarray, shape (scored samples, k)
        ``strength``, ``gain``, ``path``, ``slow power``, ``dynamics``, ``rate``,
        ``statics``, ``memory``; no ``strength`` where nothing was added to the chain.
    """
    before, after = base.simulation.output, state.simulation.output
    increments = [b - a for a, b in zip(before, after, strict=True)]
    over_time = in_runs(state)
    groups = {}
    if any(x.any() for x in increments):
        groups["strength"] = state.sample.take(increments)[:, None] * over_time
    groups["gain"] = state.sample.take(before)[:, None] * over_time
    groups["path"] = paths(state)
    largest = max(float(np.abs(record.u).max()) for record in state.records) or 1.0
    size = max(float(np.abs(y).max()) for y in after) or 1.0
    step = min(record.dt for record in state.records)
    span = max(record.dt * len(record) for record in state.records)
    fast = np.geomspace(step, min(REACH * step, span), TIMES)
    slow = np.geomspace(SLOWEST * span, span, TIMES)
    makers: dict[str, Callable[[Record, FloatArray, FloatArray], Columns]] = {
        SLOW_POWER: lambda record, u, y: _slow_power(record.dt, u, y, slow),
        "dynamics": lambda record, u, y: _dynamics(record.dt, y, fast, step),
        "rate": lambda record, u, y: _rate(record.dt, u, y),
        "statics": lambda record, u, y: _statics(u, y),
        "memory": lambda record, u, y: _memory(record.dt, u, slow),
    }
    for name, make in makers.items():
        made = [
            make(record, record.u / largest, y / size)
            for record, y in zip(state.records, after, strict=True)
        ]
        columns = [state.sample.take(signals) for signals in zip(*made, strict=True)]
        groups[name] = np.column_stack(columns)
    return groups


def halves(state: ModelState, signals: FloatArray) -> FloatArray:
    """Give signals their two halves of every run as columns of their own.

    Parameters
    ----------
    state : ModelState
    signals : ndarray, shape (scored samples, k)

    Returns
    -------
    ndarray, shape (scored samples, 2 k runs)
    """
    columns = []
    for rows in _rows_of_runs(state):
        for part in np.split(rows, [len(rows) // 2]):
            own = np.zeros_like(signals)
            own[part] = signals[part]
            columns.append(own)
    return np.hstack(columns)


def in_runs(state: ModelState) -> FloatArray:
    """Give every run a constant and cosines of its own, zero in the others.

    Windows of one record are one run, over which a strength may change.

    Returns
    -------
    ndarray, shape (scored samples, cosines and constants of all runs)
    """
    every = runs(state.records)
    return _cosines(state, every, [np.arange(SLOW_COSINES + 1)] * len(every))


def random_walks(state: ModelState) -> tuple[FloatArray, FloatArray]:
    """Give every run the cosines of a random walk of its own, zero in the others.

    Its Karhunen-Loeve expansion: about its mean, a random walk of a duration ``T`` is a
    sum of cosines with ``k`` half waves, whose amplitudes are independent and have
    standard deviations in proportion to ``sqrt(T) / k``.

    Returns
    -------
    columns : ndarray, shape (scored samples, cosines of all runs)
    sizes : ndarray, shape (cosines of all runs,)
        RMS over the samples of all runs that columns of these standard deviations have,
        the largest being one.
    """
    every = runs(state.records)
    most = WALKS_COSINES // len(every)
    number = np.arange(1, max(min(WALK_COSINES, most), PATH_COSINES) + 1)
    columns = _cosines(state, every, [number] * len(every))
    each = [[state.records[k] for k in own] for own in every]
    lasts = [sum(record.dt * len(record) for record in records) for records in each]
    sizes = np.concatenate([np.sqrt(duration) / number for duration in lasts])
    # Zeros in other runs count in the RMS of a column, which a short run has less of.
    sizes *= np.sqrt(np.mean(columns**2, axis=0))
    return columns, sizes / sizes.max()


def _cosines(
    state: ModelState,
    groups: Sequence[Sequence[int]],
    numbers: Sequence[NDArray[np.intp]],
) -> FloatArray:
    """Give groups of records cosines of their own, of so many half waves over each.

    Shape (scored samples, cosines of all groups); zero in the other groups.
    """
    sample, columns = state.sample, np.cumsum([0, *map(len, numbers)])
    # Hundreds of windows have six columns each: they are filled in, not joined.
    found = np.zeros((len(sample), columns[-1]))
    for own, number, first in zip(groups, numbers, columns, strict=False):
        lengths = [len(state.records[k]) for k in own]
        for k, before in zip(own, np.cumsum([0, *lengths]), strict=False):
            phase = np.pi * (sample.positions[k] + before + 0.5) / sum(lengths)
            cosines = np.cos(phase[:, None] * number)
            found[sample.slices[k], first : first + len(number)] = cosines
    return found


def _rows_of_runs(state: ModelState) -> list[NDArray[np.intp]]:
    """Give the scored samples of each run."""
    slices = state.sample.slices
    return [
        np.concatenate([np.arange(slices[k].start, slices[k].stop) for k in own])
        for own in runs(state.records)
    ]


def paths(
    state: ModelState, allowed: Callable[[Record], int] = lambda record: PATH_COSINES
) -> FloatArray:
    """Give every record a constant and cosines of its own, zero in the others.

    Parameters
    ----------
    state : ModelState
    allowed : callable
        Gives how many cosines a record may have, where that is more.

    Returns
    -------
    ndarray, shape (scored samples, cosines and constants of all records)
    """
    numbers = [
        np.arange(max(PATH_COSINES, allowed(record)) + 1) for record in state.records
    ]
    return _cosines(state, [[k] for k in range(len(numbers))], numbers)


def _slow_power(dt: float, u: FloatArray, y: FloatArray, times: FloatArray) -> Columns:
    averages = [low_pass(u**2, dt, tau) for tau in times]
    return [*averages, *(x * y for x in averages)]


def _dynamics(dt: float, y: FloatArray, times: FloatArray, step: float) -> Columns:
    rate = np.gradient(y, dt)
    time = dt * np.arange(len(y))
    late = [np.interp(time - k * step, time, y) - y for k in DELAYS]
    passed = [low_pass(y, dt, tau, y[0]) - y for tau in times]
    return [rate, np.gradient(rate, dt), *passed, *late]


def _rate(dt: float, u: FloatArray, y: FloatArray) -> Columns:
    rate = np.gradient(u, dt)
    size = np.abs(rate)
    root = np.sqrt(size)
    return [np.sign(rate) * root, root, size, size * u, size * y]


def _statics(u: FloatArray, y: FloatArray) -> Columns:
    return [
        *(z**k for z in (u, y) for k in (1, 2, 3, 4, 5)),
        np.abs(u),
        np.abs(y),
    ]


def _memory(dt: float, u: FloatArray, times: FloatArray) -> Columns:
    plays = list(play(u, np.array(THRESHOLDS)).T)
    return [
        *plays,
        *(x**2 for x in plays[1:3]),
        *(low_pass(u, dt, tau) for tau in times[2:]),
    ]
