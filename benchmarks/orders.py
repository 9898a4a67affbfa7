"""Cost of each filter against its order, up to 300 taps."""

from __future__ import annotations

from benchmarks.timing import interleaved, least_and_median, write_table
from benchmarks.work import adaptive, record
from hystbench.filters import FILTERS

ORDERS = (1, 3, 7, 15, 23, 30, 31, 47, 63, 99, 149, 199, 249, 299)
SAMPLES = 20_000
REPEATS = 5
TURN = 0.01  # seconds that each filter is called for on end
COLUMNS = ("filter", "order", "taps", "weights", "ns_per_sample", "ns_per_weight")


def main() -> None:
    """Write orders.csv."""
    x, d = record(SAMPLES)
    rows = []
    for order in ORDERS:
        filters = {name: adaptive(name, x, 0.1, order) for name in sorted(FILTERS)}
        candidates = {
            name: lambda each=each: each.run(x, d)  # type: ignore[misc]
            for name, each in filters.items()
        }
        for name, seconds in interleaved(candidates, REPEATS, TURN).items():
            each = filters[name]
            ns = least_and_median(seconds)[0] * 1e9 / SAMPLES
            rows.append((name, order, each.taps, each.size, ns, ns / each.size))
    write_table("orders.csv", COLUMNS, sorted(rows))
