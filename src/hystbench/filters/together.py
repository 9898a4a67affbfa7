"""Filters run together: those that differ in step size alone, and many on threads."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from hystbench import kernels
from hystbench.errors import InputError
from hystbench.filters.state import Chunk, End, Result, State, finite

if TYPE_CHECKING:
    from hystbench.filters.base import AdaptiveFilter

    Job = tuple[AdaptiveFilter, ArrayLike, ArrayLike]

LIMIT = 1e6
"""An error beyond so many times the largest ``|d|`` so far is of a diverged filter."""
CHUNK = 32000
"""Samples filtered at a time: what is made of them stays in the processor's cache."""
MOST = 32
"""Filters that are run together: their results share memory."""
SHARES = 4
"""Batches for each thread, where there are several threads and as many filters."""


def run_together(
    filters: Sequence[AdaptiveFilter],
    x: ArrayLike,
    d: ArrayLike,
    state: State | None = None,
) -> list[Result]:
    """Run filters that differ in step size alone, each as it would run by itself.

    Filters of play operators go through one call of the kernel a chunk; once some
    have diverged, neighbours that have not stay together.

    Parameters
    ----------
    filters : sequence of AdaptiveFilter
        At least one.
    x, d, state
        As for :meth:`AdaptiveFilter.run`.

    Returns
    -------
    list of Result
        Their outputs and errors are rows of one array each.

    Raises
    ------
    InputError
        As for :meth:`AdaptiveFilter.run`.
    """
    first = filters[0]
    x, _ = finite("x", x)
    d, largest = finite("d", d)
    if len(x) != len(d):
        raise InputError(f"d: {len(d)} samples given, x has {len(x)}")
    state = state or first.start()
    if state.diverged:
        raise InputError("state: the filter has diverged; expected one that goes on")
    largest = max(largest, state.largest)
    limit = LIMIT * (largest or 1.0)
    count, past = len(filters), state.past
    output, error = np.empty((count, len(d))), np.empty((count, len(d)))
    ends: list[End] = [(state.weights, state.operators)] * count
    pasts, done = [past] * count, [0] * count
    for start in range(0, len(d), CHUNK):
        part = slice(start, start + CHUNK)
        chunk = Chunk(np.concatenate((past, x[part])), d[part], limit)
        past = chunk.line[-first.history :].copy()
        for row in _neighbours([samples == start for samples in done]):
            own = range(count)[row]
            found = first._adapt_all(
                filters[row], chunk, ends[row], output[row], error[row], start
            )
            for k, (taken, end) in zip(own, found, strict=True):
                done[k] += taken
                ends[k], pasts[k] = end, past
    whole = math.isfinite(kernels.largest(np.concatenate([w for w, _ in ends])))
    results = []
    for k, (weights, operators) in enumerate(ends):
        diverged_at = done[k] if done[k] < len(d) else None
        if not whole and not np.isfinite(weights).all():
            # overflow in the last update of all: the next prediction would show it
            diverged_at = done[k]
            weights = np.nan_to_num(weights)
        diverged = diverged_at is not None
        end_state = State(weights, pasts[k], operators, largest, diverged)
        used = slice(done[k])
        results.append(
            Result(output[k, used], error[k, used], weights, diverged_at, end_state)
        )
    return results


def _neighbours(going: Sequence[bool]) -> list[slice]:
    """Give the runs of neighbours that are all going."""
    bounded = [False, *going, False]
    edges = [k for k in range(len(going) + 1) if bounded[k] != bounded[k + 1]]
    return [slice(*pair) for pair in zip(edges[::2], edges[1::2], strict=True)]


def run_many(jobs: Iterable[Job], workers: int | None = None) -> list[Result]:
    """Run many filters at once: step sizes, orders, seeds.

    Each job gives what it would give alone, so the results do not depend on
    ``workers``. Jobs may share their arrays. Filters that differ in step size alone
    are run together where x and d are the very same arrays: what comes before the
    weights is then the same.

    Parameters
    ----------
    jobs : iterable of (AdaptiveFilter, array_like, array_like)
        Filter, input x and plant output d.
    workers : int, optional
        Threads; by default one for each processor that this process may use.

    Returns
    -------
    list of Result
        In the order of the jobs. Those that were run together share memory.
    """
    listed = list(jobs)
    done: list[Result | None] = [None] * len(listed)
    count = workers or len(os.sched_getaffinity(0))
    todo = iter(_batches(listed, count))  # one for all: each thread takes the next

    def work(_: int) -> None:
        for batch in todo:
            x, d = listed[batch[0]][1:]
            results = run_together([listed[k][0] for k in batch], x, d)
            for k, result in zip(batch, results, strict=True):
                done[k] = result

    with ThreadPoolExecutor(count) as pool:
        list(pool.map(work, range(count)))  # so that what one raises is raised here
    return [result for result in done if result is not None]


def _batches(jobs: Sequence[Job], workers: int) -> list[list[int]]:
    """Divide jobs, by number, into what one thread runs together.

    Each time threads change places at the interpreter's lock costs as much as a good
    part of a short run, so a batch should be large; but all threads should end at the
    same time, so there should be several for each. Filters in a batch stand in the
    order of their step sizes: those that diverge are then neighbours, and so are
    those that :func:`run_together` goes on with.
    """
    alike: dict[object, list[int]] = {}
    for number, (item, x, d) in enumerate(jobs):
        given = [_hashed(v) for key, v in vars(item).items() if key != "step_size"]
        alike.setdefault((type(item), *given, id(x), id(d)), []).append(number)
    parts = SHARES * workers if workers > 1 else 1
    batches = []
    for numbers in alike.values():
        numbers.sort(key=lambda number: jobs[number][0].step_size)
        size = min(MOST, -(-len(numbers) // parts))
        batches += [numbers[k : k + size] for k in range(0, len(numbers), size)]
    return sorted(batches)


def _hashed(value: object) -> object:
    """Give what tells a setting from another: arrays have no hash but an identity."""
    try:
        hash(value)
    except TypeError:
        return id(value)
    return value
