"""Small inputs of every figure, made as the jobs of the workflow make them."""

from __future__ import annotations

import csv
import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from hystbench.compare.beside import EDGE_COLUMNS, Edge
from hystbench.compare.cells import ComparedCell
from hystbench.compare.rows import four_digits, names_of, or_empty, write_fields
from hystbench.envelope import PUBLISHED_ENVELOPE
from hystbench.files import write_json
from hystbench.identification import identify
from hystbench.order_errors import OrderError
from hystbench.record import Channel, FloatArray, Record
from hystbench.results import run_result, save_run

SIGNALS = ("sine-010hz", "sine-020hz", "sine-040hz")
#: Of a hold-out record in the folder of a gap.
TABLE = f"{SIGNALS[0]}.csv"
HALVES = ("calibrated", "held-out", "calibrated")
MODELS = ("gpo", "backlash", "volterra", "delayed", "rdgpi")
#: The run that diverged, after this many samples.
DIVERGED, SAMPLES = ("sine-020hz", "volterra"), 500
UNIT = "um"


def a_record(
    name: str, frequency: float = 10.0, count: int = 4000, origin: str = "twin"
) -> Record:
    """A sine and an output that lags behind it."""
    time = np.arange(count) * 1e-3
    u = 0.6 * np.sin(2 * np.pi * frequency * time)
    y = 9 * np.sin(2 * np.pi * frequency * time - 0.4) + 0.5
    given, measured = Channel("current", "A"), Channel("displacement", UNIT)
    return Record(name, 1e-3, u, y, given, measured, origin)


def save_a_run(
    folder: Path, record: Record, model: str, diverged: bool = False
) -> tuple[Path, FloatArray]:
    """Write a run whose error falls along the record, or one that diverged."""
    error = (1 + MODELS.index(model)) * np.cos(np.arange(len(record)) / 7)
    error = error / (1 + np.arange(len(record)) / 50)
    about = None
    if diverged:
        error = 0.1 * 1.02 ** np.arange(SAMPLES)
        about = {"sample": SAMPLES, "sentence": f"diverged at sample {SAMPLES}"}
    output = record.y[: len(error)] - error
    adaptive = model != "rdgpi"
    result = run_result(
        record,
        model,
        error,
        "one-step a priori" if adaptive else "free-run simulation",
        transient_fraction=0.25,
        smoothing_fraction=0.025,
        diverged=about,
    )
    if adaptive:
        result |= {"order": 1, "weights": [0.1, 0.2]}
        result |= {"step_size": {"mu": 0.1}, "bound": {"mu": 1.0}}
        result |= {"eigenvalues": {"largest": 1.0, "spread_nonzero": 2.0}}
    path = folder / record.name / f"{model}.json"
    save_run(path, path.with_suffix(".npz"), result, output, error)
    return path, output


def write_order_sweep(path: Path) -> None:
    """Write errors that fall with the order; the last one of a filter diverged."""
    points = [
        OrderError(model, order, (1 + n) / order)
        for n, model in enumerate(MODELS[:4])
        for order in (1, 2, 5, 10)
    ]
    points[-1] = replace(points[-1], mse=math.inf)
    write_fields(path, names_of(OrderError), points, or_empty)


def write_step_edges(path: Path) -> None:
    """Write edges of each filter on two signals; one was not reached."""
    edges = [
        Edge(signal, model, 0.1, 0.8, 0.4, 0.25, 0.3 + 0.1 * n, -1.0)
        for n, signal in enumerate(SIGNALS[:2])
        for model in MODELS[:4]
    ]
    edges[-1] = replace(edges[-1], edge=None)
    write_fields(path, EDGE_COLUMNS, edges, four_digits)


def write_cells(path: Path) -> None:
    """Write compared cells of which one diverged and one was not run."""
    cells = [
        ComparedCell(
            table=1,
            signal=signal,
            model=model,
            metric=metric,
            half=half,
            published="1",
            ours=10 ** (-0.5 + 0.1 * (n + k)),
            published_consistent="yes",
            status="finite",
        )
        for n, (signal, half) in enumerate(zip(SIGNALS, HALVES, strict=True))
        for k, model in enumerate(MODELS)
        for metric in ("mse", "re")
    ]
    cells[0] = replace(cells[0], published_consistent="no")
    cells[2] = replace(cells[2], published_consistent="undecided")
    cells[4] = replace(cells[4], ours=None, status="diverged at sample 7")
    cells[6] = replace(cells[6], ours=None, status="not run")
    write_fields(path, names_of(ComparedCell), cells)


BLIND_EFFECTS = ("creep", "rate-dependent-hysteresis", "stiffness-hardening")
BLIND_FAMILIES = ("gpi", "preisach", "jiles-atherton")


def write_blind(folder: Path) -> None:
    """Write the tables of a blind contest."""
    answers = [
        ["single", "creep", "creep", "yes", 9],
        ["single", "creep", "drift", "no", 1],
        ["single", "stiffness-hardening", "resonance", "no", 3],
        ["unlisted", "dropouts", "unnamed", "yes", 4],
        ["unlisted", "dropouts", "friction", "no", 1],
        ["none", "none", "hysteresis-shape", "yes", 2],
        ["none", "none", "no-gap", "yes", 12],
    ]
    _write(
        folder / "confusion.csv",
        ["kind", "hidden", "answered", "right", "cases"],
        answers,
    )
    interval = ["share", "low", "high", "cases"]
    shares = [
        [effect, family, ratio, figure, 0.8 + 0.05 * n, 0.6, 1.0, 10]
        for effect in BLIND_EFFECTS
        for n, family in enumerate(BLIND_FAMILIES)
        for ratio in (10.0, 20.0)
        for figure in ("top1", "exact", "where_hit")
    ]
    columns = ["effect", "family", "ratio_db", "figure", *interval]
    _write(folder / "effects.csv", columns, shares)
    curves = [
        [effect, family, ratio, ratio / (3 + ratio), 0.3, 1.0, 10]
        for effect in ("all", *BLIND_EFFECTS)
        for family in BLIND_FAMILIES
        for ratio in (3.0, 10.0, 20.0, 30.0)
    ]
    _write(folder / "power.csv", ["effect", "family", "ratio_db", *interval], curves)
    bins = [[0.5, 0.6, 0.55, 0.5, 0.2, 0.8, 4], [0.95, 1.0, 0.99, 0.97, 0.9, 0.99, 90]]
    _write(folder / "reliability.csv", ["from", "to", "stated", *interval], bins)


def write_gap(folder: Path, record: Record) -> None:
    """Write a hold-out table and what was named: the simulator is 1 um too high."""
    columns = ["time_s", "measured", "before", "after"]
    rows = [[t, y, y + 1.0, y] for t, y in zip(record.time, record.y, strict=True)]
    _write(folder / "holdout" / TABLE, columns, rows)
    write_json(
        folder / "gap.json",
        {
            "effects": [{"name": "sensor-lag"}],
            "base_parameters": {"gpi.weights": {"before": [1.0], "after": [1.1]}},
        },
    )


def write_identified(path: Path, record: Record) -> None:
    """Run a short Algorithm 1 on a record."""
    found = identify(
        record.u, record.y, 4, starts=1, max_iterations=5, published=PUBLISHED_ENVELOPE
    )
    write_json(path, found.to_dict())


def _write(path: Path, header: list[str], rows: list[list[object]]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(header)
        writer.writerows(rows)


class Inputs:
    """All files that figures take, below a folder."""

    def __init__(self, folder: Path, origin: str = "twin") -> None:
        """Write the files."""
        self.records = {}
        for n, name in enumerate(SIGNALS):
            record = a_record(name, 10.0 * 2**n, origin=origin)
            self.records[name] = record
            record.save(folder / "records" / f"{name}.npz")
            for model in MODELS:
                lost = (name, model) == DIVERGED
                save_a_run(folder / "filters", record, model, lost)
        self.folder = folder
        write_order_sweep(folder / "errors.csv")
        write_cells(folder / "cells.csv")
        write_step_edges(folder / "edges.csv")
        write_blind(folder / "blind")
        write_gap(folder / "gap", self.records[SIGNALS[0]])
        write_identified(folder / "identified.json", self.records[SIGNALS[0]])

    def record(self, *names: str) -> list[Path]:
        """Archives of records."""
        return [self.folder / "records" / f"{name}.npz" for name in names]

    def runs(self, names: tuple[str, ...], models: tuple[str, ...]) -> list[Path]:
        """Runs of models on records."""
        folder = self.folder / "filters"
        return [folder / name / f"{model}.json" for name in names for model in models]

    def of(self, figure: str) -> dict[str, object]:
        """Give a figure what it is drawn from."""
        one = {"records": self.record(SIGNALS[0])}
        pair = one | {"runs": self.runs(SIGNALS[:1], ("gpo",))}
        loops = {
            "records": self.record(*SIGNALS),
            "runs": self.runs(SIGNALS, ("gpo",)),
        }
        everything = {"runs": self.runs(SIGNALS, MODELS)}
        return {
            "figure-03-play": {},
            "figure-04-generalized-play": {},
            "figure-07-order": one | {"table": self.folder / "errors.csv"},
            "figure-08-loops": loops,
            "headline": loops,
            "figure-09-chirp": pair,
            "figure-10-sum": pair,
            "figure-11-sum": pair,
            "figure-12-random-sum": pair,
            "identification": one | {"identified": self.folder / "identified.json"},
            "learning-curves": everything,
            "errors-heat-map": {"table": self.folder / "cells.csv"},
            "step-edges": {"table": self.folder / "edges.csv"},
            "gap-loop": one | {"table": self.folder / "gap/holdout" / TABLE},
            "blind-confusion": {"table": self.folder / "blind" / "confusion.csv"},
            "blind-effects": {"table": self.folder / "blind" / "effects.csv"},
            "blind-power": {"table": self.folder / "blind" / "power.csv"},
            "blind-reliability": {"table": self.folder / "blind" / "reliability.csv"},
            "blind-where": {"table": self.folder / "blind" / "effects.csv"},
            "loops": everything | {"records": self.record(*SIGNALS)},
            "errors-by-record": everything,
        }[figure]
