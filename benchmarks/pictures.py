"""Pictures of the tables, for docs/speed.md."""

from __future__ import annotations

import csv
from pathlib import Path

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import hystbench
from benchmarks.timing import OUT
from hystbench.figures.style import BLUE, LOOKS
from hystbench.files import atomic_path

STYLE = Path(hystbench.__file__).parent / "figures" / "hystbench.mplstyle"
Rows = list[dict[str, str]]


def main() -> None:
    """Draw kernels.png and growth.png."""
    mpl.use("agg")
    with mpl.rc_context(fname=STYLE):
        save(kernels(read("kernels.csv")), "kernels.png")
        save(growth(read("orders.csv"), read("samples.csv")), "growth.png")


def read(name: str) -> Rows:
    """Read a table."""
    with (OUT / name).open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def save(figure: Figure, name: str) -> None:
    """Write a picture whole or not at all."""
    with atomic_path(OUT / name) as temporary:
        figure.savefig(temporary, dpi=200)


def kernels(rows: Rows) -> Figure:
    """How many times as long each peer takes, one panel a kernel."""
    panels: dict[str, Rows] = {}
    for row in rows:
        panels.setdefault(
            f"{row['kernel']}, {int(row['samples']):,} samples", []
        ).append(row)
    figure = Figure(figsize=(6.5, 0.3 + 0.15 * len(rows) + 0.35 * len(panels)))
    heights = [len(found) + 1 for found in panels.values()]
    axes = figure.subplots(len(panels), sharex=True, height_ratios=heights)
    for place, (title, found) in zip(axes, panels.items(), strict=True):
        found = sorted(found, key=lambda row: -float(row["ratio"]))
        names = [row["peer"] for row in found]
        ratios = [float(row["ratio"]) for row in found]
        place.hlines(names, 1, ratios, color="0.7", linewidth=2)
        place.plot(ratios, names, "o", color=BLUE)
        place.axvline(1, color="0.3", linewidth=0.8)
        place.set(xscale="log", title=title, ylim=(len(names) - 0.5, -0.5))
    axes[-1].set_xlabel("time of the peer / time of hystbench")
    figure.set_layout_engine("constrained")
    return figure


def growth(orders: Rows, samples: Rows) -> Figure:
    """Cost against order, and cost and memory against samples."""
    figure = Figure(figsize=(6.5, 2.4))
    cost, length, memory = figure.subplots(1, 3)
    lines(cost, orders, "taps", "ns_per_sample")
    cost.set(xscale="log", yscale="log", xlabel="taps", ylabel="time a sample (ns)")
    lines(length, samples, "samples", "seconds")
    length.set(xscale="log", yscale="log", xlabel="samples", ylabel="time (s)")
    lines(memory, samples, "samples", "peak_mib")
    memory.set(xscale="log", xlabel="samples", ylabel="peak memory (MiB)")
    memory.set_ylim(0, 1.15 * memory.get_ylim()[1])
    cost.legend()
    figure.set_layout_engine("constrained")
    return figure


def lines(axes: Axes, rows: Rows, across: str, up: str) -> None:
    """Draw a line for each filter."""
    for name in dict.fromkeys(row["filter"] for row in rows):
        mine = [row for row in rows if row["filter"] == name]
        mine.sort(key=lambda row: float(row[across]))
        points = [[float(row[key]) for row in mine] for key in (across, up)]
        axes.plot(*points, **LOOKS[name].marked)


if __name__ == "__main__":
    main()
