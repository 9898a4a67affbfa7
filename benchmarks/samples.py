"""Cost and memory against the number of samples, chunk after chunk to 1e8.

Each size runs in a process of its own, so that its peak memory is its own. The chunks
are one record's, again and again: what is filtered is kept nowhere.
"""

from __future__ import annotations

import json
import subprocess
import sys
from time import perf_counter

import numpy as np

from benchmarks.timing import peak_mib, write_table
from benchmarks.work import adaptive, record
from hystbench.filters import FILTERS

CHUNK = 100_000
SIZES = (100_000, 1_000_000, 10_000_000, 100_000_000)
LEAST = 20_000_000
"""Samples over which the time of a short stream is averaged."""
COLUMNS = (
    *("filter", "samples", "seconds", "ns_per_sample"),
    *("peak_mib", "mean_square_error", "diverged"),
)


def main() -> None:
    """Write samples.csv."""
    rows = []
    for name in sorted(FILTERS):
        for samples in SIZES:
            words = [sys.executable, "-m", "benchmarks.samples", name, str(samples)]
            done = subprocess.run(words, check=True, capture_output=True, text=True)
            rows.append((name, samples, *json.loads(done.stdout)))
    write_table("samples.csv", COLUMNS, rows)


def stream(name: str, samples: int) -> tuple[float, float, float, float, bool]:
    """Filter so many samples in chunks; tell time, memory and error."""
    x, d = record(CHUNK)
    each = adaptive(name, x, 0.1)
    repeats = max(1, LEAST // samples)
    start = perf_counter()
    for _ in range(repeats):
        state, squares, diverged = each.start(), 0.0, False
        for _ in range(samples // CHUNK):
            result = each.run(x, d, state)
            state = result.state
            squares += float(np.dot(result.error, result.error))
            diverged = diverged or result.diverged_at is not None
    seconds = (perf_counter() - start) / repeats
    return seconds, seconds * 1e9 / samples, peak_mib(), squares / samples, diverged


if __name__ == "__main__":
    print(json.dumps(stream(sys.argv[1], int(sys.argv[2]))))
