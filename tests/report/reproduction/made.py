"""Results made small: real tables and pictures of synthetic runs."""

from __future__ import annotations

import csv
from pathlib import Path

from hystbench.compare.comparison import Comparison, held_out_signals
from hystbench.compare.measured import compare_measured
from hystbench.compare.runs import read_evidence
from hystbench.figures import drawer, style
from hystbench.published.split import CALIBRATION_SIGNALS
from hystbench.report.reproduction.page import page
from hystbench.report.reproduction.read import Results
from tests.conftest import ROOT
from tests.figures.inputs import MODELS, a_record, save_a_run

#: One that the twin is fitted to and two that it is not; one run of them diverges.
SIGNALS = ("sine-010hz", "sine-060hz", "sine-120hz")
DIVERGED = ("sine-120hz", "volterra")
CAPTIONS = ROOT / "workflow" / "report"
SETTINGS = {
    "dataset": None,
    "order_sweep": {"signal": "sine-050hz", "convergence_factor": "constant"},
}


def make_runs(folder: Path, names, models=MODELS, origin="twin") -> list[Path]:
    runs = []
    for number, name in enumerate(names):
        record = a_record(name, 10.0 * 2**number, 1000, origin)
        record.save(folder / "records" / f"{name}.npz")
        runs += [
            save_a_run(folder / "filters", record, model, (name, model) == DIVERGED)[0]
            for model in models
        ]
    return runs


def draw(folder: Path, name: str, **given) -> Path:
    with style.in_style():
        figure = drawer(name)(**given)
        style.save(figure, folder / f"{name}.svg")
    # The page links the PNG beside it and does not read it.
    (folder / f"{name}.png").touch()
    return folder / f"{name}.svg"


def make_results(folder: Path, names=SIGNALS, models=MODELS) -> list[Path]:
    """Write what the page of a reproduction needs; give its figures."""
    runs = make_runs(folder, names, models)
    held_out = held_out_signals(CALIBRATION_SIGNALS)
    Comparison(read_evidence(runs), held_out).write(folder / "compare")
    figures = [draw(folder / "figures", "figure-03-play")]
    if "gpo" in models:
        records = [folder / "records" / f"{name}.npz" for name in names]
        own = [run for run in runs if run.stem == "gpo"]
        figures.append(draw(folder / "figures", "headline", records=records, runs=own))
    return figures


def make_measured(folder: Path) -> list[Path]:
    """Write what the page of a measured dataset needs; give its figures."""
    names = ("slow", "it's $HOME <b>")
    runs = make_runs(folder, names, origin="measured")
    compare_measured(folder / "compare", "bench", runs)
    return [draw(folder / "figures", "errors-by-record", runs=runs)]


def make_page(folder: Path, figures: list[Path], tables=(), **settings) -> Path:
    out = folder / "report.html"
    results = Results(
        out.parent, folder / "compare", figures, tables, CAPTIONS, SETTINGS | settings
    )
    out.write_text(page(results), encoding="utf-8")
    return out


def write_rows(path: Path, content: list[dict[str, str]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.DictWriter(stream, list(content[0]))
        writer.writeheader()
        writer.writerows(content)
