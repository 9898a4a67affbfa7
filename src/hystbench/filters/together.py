"""Filters that differ in step size alone, run together over a record."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from hystbench import kernels
from hystbench.errors import InputError
from hystbench.filters.state import Chunk, End, Result, State, finite, positive

if TYPE_CHECKING:
    from hystbench.filters.base import AdaptiveFilter

CHUNK = 32000
"""Samples filtered at a time: what is made of them stays in the processor's cache."""


def run_together(
    filters: Sequence[AdaptiveFilter],
    x: ArrayLike,
    d: ArrayLike,
    state: State | None = None,
    limit: float | None = None,
) -> list[Result]:
    """Run filters that differ in step size alone, each as it would run by itself.

    Filters of play operators go through one call of the kernel a chunk; once some
    have diverged, neighbours that have not stay together.

    Parameters
    ----------
    filters : sequence of AdaptiveFilter
        At least one.
    x, d, state, limit
        As for :meth:`AdaptiveFilter.run`.

    Returns
    -------
    list of Result
        Their outputs and errors are rows of one array each.

    Raises
    ------
    InputError
        If there is no filter, if they differ in more than the step size, and as for
        :meth:`AdaptiveFilter.run`.
    """
    if not filters:
        raise InputError("filters: none given, at least one expected")
    first = filters[0]
    if len(filters) > 1:
        _refuse_unlike(filters)
    x, _ = finite("x", x)
    d, largest = finite("d", d)
    if len(x) != len(d):
        raise InputError(f"d: {len(d)} samples given, x has {len(x)}")
    state = state or first.start()
    if state.diverged:
        raise InputError("state: the filter has diverged; expected one that goes on")
    largest = max(largest, state.largest)
    kept = state.limit if limit is None else limit
    limit = 1e6 * (largest or 1.0) if kept is None else kept
    positive("limit", limit)
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
        end_state = State(weights, pasts[k], operators, kept, largest, diverged)
        used = slice(done[k])
        results.append(
            Result(output[k, used], error[k, used], weights, diverged_at, end_state)
        )
    return results


def but_step_size(item: AdaptiveFilter) -> dict[str, object]:
    """Give what must be the same of filters that are run together.

    Settings count by value; those without a hash, as arrays, by identity.
    """
    values = {key: value for key, value in vars(item).items() if key != "step_size"}
    return {"filter": type(item)} | {key: _hashed(v) for key, v in values.items()}


def _hashed(value: object) -> object:
    try:
        hash(value)
    except TypeError:
        return id(value)
    return value


def _refuse_unlike(filters: Sequence[AdaptiveFilter]) -> None:
    one = but_step_size(filters[0])
    for number, item in enumerate(filters[1:], 1):
        other = but_step_size(item)
        if one != other:
            keys = (key for key in one | other if one.get(key) != other.get(key))
            raise InputError(
                f"filters: number {number} has another {next(keys)} than number 0; "
                "run together, they may differ in step_size alone"
            )


def _neighbours(going: Sequence[bool]) -> list[slice]:
    """Give the runs of neighbours that are all going."""
    bounded = [False, *going, False]
    edges = [k for k in range(len(going) + 1) if bounded[k] != bounded[k + 1]]
    return [slice(*pair) for pair in zip(edges[::2], edges[1::2], strict=True)]
