"""Times of several candidates, taken in turn, and tables of them."""

from __future__ import annotations

import gc
import statistics
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from time import perf_counter
from typing import Any

from hystbench.files import write_csv

OUT = Path("results", "benchmarks")


def interleaved(
    candidates: Mapping[str, Callable[[], object]], repeats: int
) -> dict[str, list[float]]:
    """Take the time of each candidate in turn, so that all see the same machine.

    Returns
    -------
    dict of str to list of float
        Seconds of each repeat.
    """
    seconds: dict[str, list[float]] = {name: [] for name in candidates}
    for _ in range(repeats):
        for name, candidate in candidates.items():
            gc.collect()
            start = perf_counter()
            kept = candidate()
            seconds[name].append(perf_counter() - start)
            del kept
    return seconds


def least_and_median(seconds: Sequence[float]) -> tuple[float, float]:
    """Least time, which others on the machine disturb least, and the median."""
    return min(seconds), statistics.median(seconds)


def write_table(
    name: str, columns: Sequence[str], rows: Sequence[Sequence[Any]]
) -> None:
    """Write and print a table; floats to four digits, which is more than is known."""
    told = [[_short(value) for value in row] for row in rows]
    write_csv(OUT / name, columns, told)
    print(",".join(columns))
    for row in told:
        print(",".join("" if value is None else str(value) for value in row))


def _short(value: Any) -> Any:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.4g}" if isinstance(value, float) else value
