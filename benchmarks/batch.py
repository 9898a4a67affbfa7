"""Many filters in one call over the cores, beside what two busy loops gain.

Two busy loops share nothing but the machine: what they gain is what it has to give.
``efficiency`` is our gain over theirs, measured in turn.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace

from benchmarks.timing import interleaved, least_and_median, write_table
from benchmarks.work import adaptive, record
from hystbench.filters import AdaptiveFilter, run_many
from hystbench.record import FloatArray

COLUMNS = (
    *("batch", "filters", "samples", "seconds_one", "seconds_all", "gain"),
    *("busy_gain", "efficiency", "same_bytes"),
)
SAMPLES = 20_000
REPEATS = 5
BUSY = "n = 0\nfor i in range(6_000_000): n += i"
ORDERS = (*range(1, 11), 12, 14, 16, 18, 20, 25, 30, 35, 40)  # Figure 7's
NAMES = ("gpo", "backlash", "volterra", "delayed")

Job = tuple[AdaptiveFilter, FloatArray, FloatArray]


def main() -> None:
    """Write batch.csv."""
    cores = os.cpu_count() or 1
    rows = []
    for name, jobs in batches().items():
        seconds = interleaved(
            {
                "one": runner(jobs, 1),
                "all": runner(jobs, cores),
                "busy one": lambda: busy(1),
                "busy all": lambda: busy(cores),
            },
            REPEATS,
        )
        least = {key: least_and_median(values)[0] for key, values in seconds.items()}
        gain = least["one"] / least["all"]
        busy_gain = cores * least["busy one"] / least["busy all"]
        one, every = run_many(jobs, 1), run_many(jobs, cores)
        same = all(
            a.error.tobytes() == b.error.tobytes()
            and a.weights.tobytes() == b.weights.tobytes()
            for a, b in zip(one, every, strict=True)
        )
        times = (least["one"], least["all"], gain, busy_gain, gain / busy_gain)
        rows.append((name, len(jobs), SAMPLES, *times, same))
    write_table("batch.csv", COLUMNS, rows)


def batches() -> dict[str, list[Job]]:
    """Step sizes, orders and seeds, as the contest, Figure 7 and the ensembles do."""
    x, d = record(SAMPLES)
    steps = [
        (replace(each, step_size=each.step_size * factor), x, d)
        for each in [adaptive("gpo", x, 0.5)]
        for factor in [2.0 ** -(number / 32) for number in range(256)]
    ]
    orders = [
        (adaptive(name, x, 0.1, order), x, d) for name in NAMES for order in ORDERS
    ]
    records = [record(SAMPLES, seed) for seed in range(16)]
    seeds = [(adaptive(name, u, 0.1), u, y) for u, y in records for name in NAMES]
    return {"step sizes": steps, "orders": orders, "seeds": seeds}


def runner(jobs: list[Job], workers: int) -> Callable[[], object]:
    """One call for all jobs."""
    return lambda: run_many(jobs, workers)


def busy(count: int) -> None:
    """So many busy loops at once, each the same work."""
    started = [subprocess.Popen([sys.executable, "-c", BUSY]) for _ in range(count)]
    for each in started:
        each.wait()


if __name__ == "__main__":
    main()
