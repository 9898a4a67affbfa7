"""Many filters in one call over the cores, beside what two busy loops gain.

Busy loops, as many as there are cores, share nothing but the machine: what they gain is
what it has to give. They are timed inside their processes, which begin at a word, so
that no start of Python is in it. ``efficiency`` is our gain over theirs, measured in
turn; all times are medians of the repeats. Beyond 1 it is noise.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace

from benchmarks.timing import interleaved, write_table
from benchmarks.work import adaptive, record
from hystbench.filters import AdaptiveFilter, run_many
from hystbench.record import FloatArray

COLUMNS = (
    *("batch", "filters", "samples", "seconds_one", "seconds_all", "gain"),
    *("busy_gain", "efficiency", "same_bytes"),
)
SAMPLES = 20_000
REPEATS = 15
TURN = 0.25  # seconds that ours is called for on end: about as long as a busy loop
BUSY = """
from time import perf_counter
print("ready", flush=True)
input()
begin, n = perf_counter(), 0
for i in range(6_000_000): n += i
print(begin, perf_counter())
"""
ORDERS = (*range(1, 11), 12, 14, 16, 18, 20, 25, 30, 35, 40)  # Figure 7's
NAMES = ("gpo", "backlash", "volterra", "delayed")

Job = tuple[AdaptiveFilter, FloatArray, FloatArray]


def main() -> None:
    """Write batch.csv."""
    cores = len(os.sched_getaffinity(0))  # as run_many counts them
    rows = []
    for name, jobs in batches().items():
        found = medians(jobs, cores)
        gain = found["one"] / found["all"]
        busy_gain = cores * found["busy one"] / found["busy all"]
        one, every = run_many(jobs, 1), run_many(jobs, cores)
        same = all(
            a.error.tobytes() == b.error.tobytes()
            and a.weights.tobytes() == b.weights.tobytes()
            for a, b in zip(one, every, strict=True)
        )
        times = (found["one"], found["all"], gain, busy_gain, gain / busy_gain)
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


def medians(jobs: list[Job], cores: int) -> dict[str, float]:
    """Take in turn: ours on one core and on all, one busy loop and as many as cores."""
    ours = {"one": runner(jobs, 1), "all": runner(jobs, cores)}
    seconds: dict[str, list[float]] = {}
    for _ in range(REPEATS):
        turn = {key: times[0] for key, times in interleaved(ours, 1, TURN).items()}
        turn |= {"busy one": busy(1), "busy all": busy(cores)}
        for key, value in turn.items():
            seconds.setdefault(key, []).append(value)
    return {key: statistics.median(values) for key, values in seconds.items()}


def runner(jobs: list[Job], workers: int) -> Callable[[], object]:
    """One call for all jobs."""
    return lambda: run_many(jobs, workers)


def busy(count: int) -> float:
    """Seconds of so many busy loops: from the first to begin to the last to end."""
    loops = [
        subprocess.Popen(
            [sys.executable, "-c", BUSY],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        for _ in range(count)
    ]
    for told in [each.stdout for each in loops if each.stdout]:
        told.readline()  # until all are ready
    for word in [each.stdin for each in loops if each.stdin]:
        word.write("go\n")
        word.flush()
    times = [each.communicate()[0].split() for each in loops]
    # the clock is one for all processes
    return max(float(end) for _, end in times) - min(float(begin) for begin, _ in times)


if __name__ == "__main__":
    main()
