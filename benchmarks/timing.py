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
    candidates: Mapping[str, Callable[[], object]], repeats: int, at_least: float = 0.0
) -> dict[str, list[float]]:
    """Take the time of each candidate in turn, so that all see the same machine.

    In its turn a candidate is called over and over for ``at_least`` seconds, once at
    the least, and the mean call counts.

    Returns
    -------
    dict of str to list of float
        Seconds of a call in each repeat.
    """
    seconds: dict[str, list[float]] = {name: [] for name in candidates}
    gc.collect()
    gc.disable()  # as timeit does: it would run in whatever candidate is at hand
    try:
        for _ in range(repeats):
            for name, candidate in candidates.items():
                seconds[name].append(_mean_call(candidate, at_least))
    finally:
        gc.enable()
    return seconds


def _mean_call(candidate: Callable[[], object], at_least: float) -> float:
    calls, start = 0, perf_counter()
    while True:
        candidate()
        calls += 1
        taken = perf_counter() - start
        if taken >= at_least:
            return taken / calls


def least_and_median(seconds: Sequence[float]) -> tuple[float, float]:
    """Least time, which others on the machine disturb least, and the median."""
    return min(seconds), statistics.median(seconds)


def peak_mib() -> float:
    """Most memory that this process has held, in MiB.

    As Linux tells it: ``ru_maxrss`` also knows what the process that began this one
    held at that time.
    """
    status = Path("/proc/self/status").read_text(encoding="utf-8")
    (line,) = (x for x in status.splitlines() if x.startswith("VmHWM:"))
    return int(line.split()[1]) / 1024


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
