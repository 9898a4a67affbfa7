"""What was asked of the project's speed, beside what the other parts measured.

A figure whose table or row is not there is listed as not measured. Of several repeats
of a measurement the median counts, of several rows that a figure speaks of the worst.
"""

from __future__ import annotations

import csv
import math
import statistics
from collections.abc import Iterable, Iterator

from benchmarks.pipeline import CHANGED, NEEDED
from benchmarks.timing import OUT, write_table

NOT_MEASURED = "not measured"
COLUMNS = ("figure", "asked", "reached", "met")
#: Kernels and the samples that they are measured on.
KERNELS = (
    *(("LMS", 20_000), ("LMS", 1_000_000), ("backlash", 20_000), ("gpo", 20_000)),
    *(("volterra", 20_000), ("GPI simulation", 20_000), ("RDGPI simulation", 20_000)),
)
PEERS = ("padasip", "adaptfilt", "PyDaptiveFiltering")
BATCHES = ("step sizes", "orders", "seeds")

LINEAR = 1.05
"""A power, or a ratio of memory, up to which it counts as linear, or as constant."""

MEDIAN_CASE, WORST_CASE = 1.5, 5.0
"""Seconds of computing that a case of the gap workflow may take, of 70,000 samples."""

Rows = list[dict[str, str]]
Reached = tuple[str, str, float | None, str]


def main() -> None:
    """Write reach.csv."""
    write_table("reach.csv", COLUMNS, list(reach()))


def reach() -> Iterator[Reached]:
    """List each figure with what was asked and what was reached."""
    yield from kernels(table("kernels.csv"))
    batches = table("batch.csv")
    for name in BATCHES:
        found = column(batches, "efficiency", batch=name)
        yield least(f"many filters in one call, {name}: of two busy loops", 0.9, found)
    yield from streams(table("samples.csv"))
    yield from identification(table("identification.csv"))
    seconds = table("pipeline.csv")
    for what, limit in NEEDED.items():
        same = [r for r in seconds if r["what"] == what or is_changed(r["what"], what)]
        found = column(same, "median_seconds")
        yield most(f"{what}: median seconds", limit, found)
    found = column(table("gap.csv"), "seconds", what="a case")
    middle = [statistics.median(found)] if found else []
    gap = "a case of the gap workflow, seconds of computing on one core"
    yield most(f"{gap}: median of the cases", MEDIAN_CASE, middle)
    yield most(f"{gap}: worst of the cases", WORST_CASE, found)
    rounds = [row for row in table("gap.csv") if row["what"] == "a round"]
    for name, other in (("samples", "candidates"), ("candidates", "samples")):
        whole = max((row[other] for row in rounds), key=int, default="")
        found = power([row for row in rounds if row[other] == whole], name)
        yield most(f"a round of naming: power of its cost in {name}", LINEAR, found)


def kernels(rows: Rows) -> Iterator[Reached]:
    """Ratios to the peers, to NumPy loops and to C."""
    for samples in (20_000, 1_000_000):
        for peer in PEERS:
            found = column(
                rows, "median_ratio", kernel="LMS", peer=peer, samples=samples
            )
            yield least(f"LMS, {samples:,} samples: times {peer}", 150, found)
    for kernel in ("gpo", "volterra"):
        found = column(rows, "median_ratio", kernel=kernel, peer="NumPy loop")
        yield least(f"{kernel}: times a NumPy loop", 100, found)
    found = column(rows, "median_ratio", kernel="volterra", peer="PyDaptiveFiltering")
    yield least("volterra: times PyDaptiveFiltering", 1000, found)
    allowed = [
        row
        for row in rows
        if row["peer"].startswith("C,") and "-ffast-math" not in row["peer"]
    ]
    for kernel, samples in KERNELS:
        found = column(allowed, "median_ratio", kernel=kernel, samples=samples)
        # its least ratio is that of the fastest
        over = [1 / min(found)] if found else []
        yield most(f"{kernel}, {samples:,} samples: time over the best C", 1.3, over)
    # A row says it of ours and the peer together: one yes is enough for ours.
    same: dict[tuple[str, str], float] = {}
    for row in rows:
        key, told = (row["kernel"], row["samples"]), float(row["same_result"] == "yes")
        same[key] = max(told, same.get(key, 0.0))
    yield least("all kernels: the same result as plain loops", 1, [*same.values()])


def streams(rows: Rows) -> Iterator[Reached]:
    """Cost and memory of up to 10^8 samples, chunk after chunk, of each filter."""
    names = {row["filter"] for row in rows}
    found = [
        slope
        for name in names
        for slope in power([row for row in rows if row["filter"] == name], "samples")
    ]
    yield most("samples in chunks to 10^8: power of the cost", LINEAR, found)
    few = column(rows, "peak_mib", samples=1_000_000)
    many = column(rows, "peak_mib", samples=100_000_000)
    over = [its / least for its, least in zip(many, few, strict=True)]
    what = "10^8 samples in chunks: peak memory over that of 10^6"
    yield most(what, LINEAR, over)


def power(rows: Rows, name: str) -> list[float]:
    """Slope of log seconds against the log of a size; one is a linear cost."""
    if len(rows) < 2:
        return []
    sizes = [math.log(float(row[name])) for row in rows]
    seconds = [math.log(float(row["seconds"])) for row in rows]
    return [statistics.linear_regression(sizes, seconds).slope]


def identification(rows: Rows) -> Iterator[Reached]:
    """Time and error of each rival over ours."""
    for name, limit in (("least squares", 3), ("differential evolution", 100)):
        mine = [row for row in rows if row["method"].startswith(name)]
        # One that ended below our error was not slower, however long it went on.
        found = [
            float(row["seconds_over_ours"]) * (float(row["error_over_ours"]) >= 1)
            for row in mine
        ]
        yield least(f"identification: times faster than {name}", limit, found)
    others = [row for row in rows if row["method"] != "variable projection"]
    found = column(others, "error_over_ours")
    yield least("identification: error of the best rival over ours", 1, found)


def is_changed(name: str, what: str) -> bool:
    """Tell whether a row of pipeline.csv is one filter's, whose step size changed."""
    return what == CHANGED and name.startswith(f"{CHANGED}, ")


def table(name: str) -> Rows:
    """Read a table; no rows where it is not there."""
    file = OUT / name
    if not file.is_file():
        return []
    with file.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def column(rows: Iterable[dict[str, str]], name: str, **where: object) -> list[float]:
    """Take the numbers of a column, of the rows that hold all that is given."""
    return [
        float(row[name])
        for row in rows
        if all(row[key] == str(value) for key, value in where.items())
    ]


def least(figure: str, asked: float, found: list[float]) -> Reached:
    """Hold a figure that must be so large or more."""
    if not found:
        return figure, f">= {asked:g}", None, NOT_MEASURED
    return figure, f">= {asked:g}", min(found), met(min(found) >= asked)


def most(figure: str, asked: float, found: list[float]) -> Reached:
    """Hold a figure that must be so large or less."""
    if not found:
        return figure, f"<= {asked:g}", None, NOT_MEASURED
    return figure, f"<= {asked:g}", max(found), met(max(found) <= asked)


def met(is_met: bool) -> str:
    """Say it in the table's words."""
    return "yes" if is_met else "no"


if __name__ == "__main__":
    main()
