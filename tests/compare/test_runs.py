"""Readers of the runs' files, and a comparison from files to files."""

import json
import math

import pytest

from hystbench.compare.comparison import WRITTEN, Comparison
from hystbench.compare.rows import read_items
from hystbench.compare.runs import (
    read_envelope_errors,
    read_evidence,
    read_run,
)
from hystbench.errors import InputError
from hystbench.order_errors import OrderError
from hystbench.written import ENTRIES

from .made import sum_records

RUN = {
    "signal": "sine-010hz",
    "model": "gpo",
    "origin": "twin",
    "error_kind": "one-step a priori",
    "samples": 3,
    "dt_s": 1e-4,
    "order": 30,
    "taps": 31,
    "weights": [0.0] * 31,
    "step_size": {"mu": 1.0},
    "bound": {"mu": 2.0},
    "status": "finite",
    "diverged": None,
    "mse": 0.01,
    "re": 0.02,
    "mse_after_transient": 0.005,
    "re_after_transient": 0.01,
    "convergence_s": 0.5,
    "transient_s": 0.5,
    "eigenvalues": {"largest": 0.4, "spread": None, "spread_nonzero": 1e3},
    "units": {"mse": "um^2"},
}
OF_FILTER = ("order", "taps", "weights", "step_size", "bound", "eigenvalues")
FREE_RUN = {key: value for key, value in RUN.items() if key not in OF_FILTER}
FREE_RUN |= {"model": "rdgpi", "error_kind": "free-run simulation"}
DIVERGED = {
    **RUN,
    "status": "diverged",
    "diverged": {"sample": 9, "sentence": "diverged at sample 9, mu = 1"},
    **dict.fromkeys(
        ("mse", "re", "mse_after_transient", "re_after_transient", "convergence_s")
    ),
}
IDENTIFIED = {
    "envelope": {f"a{j}": 1.0 for j in range(8)},
    "thresholds": [0.0, 0.1],
    "weights": [1.0, 2.0],
    "J": [3.0, 2.0],
    "epsilon": 1.0,
    "reached": False,
    "relative_error": 0.01,
    "published_relative_error": 0.03,
}


def write(path, content):
    path.write_text(json.dumps(content), encoding="utf-8")
    return path


def test_run_is_read(tmp_path):
    run = read_run(write(tmp_path / "run.json", RUN))
    assert run.mse == run.error("mse") == 0.01
    assert run.bound == {"mu": 2.0}
    assert run.spread == 1e3
    assert run.weight_count == 31
    assert run.status == "finite"


def test_free_run_needs_nothing_of_a_filter(tmp_path):
    run = read_run(write(tmp_path / "run.json", FREE_RUN))
    assert run.order is None
    assert run.step_size == {}


def test_diverged_run_is_read(tmp_path):
    run = read_run(write(tmp_path / "run.json", DIVERGED))
    assert run.status == "diverged at sample 9, mu = 1"
    assert math.isinf(run.error("mse"))
    assert math.isinf(run.error("re"))


def test_order_sweep_is_read(tmp_path):
    path = tmp_path / "errors.csv"
    path.write_text(
        "model,order,mse,status,rule\ngpo,1,0.5,finite,constant\n"
        "gpo,2,,diverged at sample 4,constant\n",
        encoding="utf-8",
    )
    first, second = read_items(path, OrderError)
    assert (first.model, first.order, first.mse) == ("gpo", 1, 0.5)
    assert math.isinf(second.mse)


def test_bad_number_and_missing_column_are_named(tmp_path):
    path = tmp_path / "errors.csv"
    path.write_text(
        "model,order,mse,status,rule\ngpo,1,x,finite,constant\n", encoding="utf-8"
    )
    with pytest.raises(InputError, match="row 1: 'x' is not a number"):
        read_items(path, OrderError)
    path.write_text("model,ordr,mse,status,rule\n", encoding="utf-8")
    with pytest.raises(InputError, match="no column 'order'; did you mean 'ordr'"):
        read_items(path, OrderError)


def test_envelope_errors_are_read(tmp_path):
    path = tmp_path / "envelopes.csv"
    path.write_text(
        "signal,envelopes,mse,re,status\na,identified,0.5,0.1,finite\n",
        encoding="utf-8",
    )
    assert read_envelope_errors(path) == {("a", "identified"): 0.5}


def test_from_files_to_files(tmp_path):
    made = {"gpo": RUN, "rdgpi": FREE_RUN}
    runs = [write(tmp_path / f"{name}.json", run) for name, run in made.items()]
    records = []
    for name, record in sum_records().items():
        record.save(tmp_path / f"{name}.npz")
        records.append(tmp_path / f"{name}.npz")
    out = tmp_path / "compare"
    identified = write(tmp_path / "identified.json", IDENTIFIED)
    evidence = read_evidence(runs, records, identified=identified)
    Comparison(evidence, ["sine-060hz"]).write(out)
    names = {name for name in WRITTEN if "*" not in name} - {"added.csv"}
    assert {p.name for p in out.iterdir()} - {ENTRIES} == names | {"tables"}
    assert len(list((out / "tables").glob("table-*"))) == 12
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    assert summary["cells"] == 1
    assert summary["rdgpi"]["cells"] == 1
    assert summary["held_out"]["cells_published"] == 4
