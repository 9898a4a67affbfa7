"""The real pipeline on a small config: what is made, and what is made again."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
import yaml

from tests.browser.seen import SIZES, all_faults, look
from tests.conftest import ROOT
from tests.conftest import table as rows

from .conftest import Workflow

FILTERS = ["gpo", "backlash", "volterra", "delayed"]


def load(path):
    return json.loads(path.read_text())


def test_every_stage_leaves_its_files(finished):
    results = finished.folder / "results"
    for signal in ["sine-100hz", "sine-200hz"]:
        for model in [*FILTERS, "rdgpi"]:
            run = load(results / "filters" / signal / f"{model}.json")
            assert (run["signal"], run["model"], run["origin"]) == (
                signal,
                model,
                "twin",
            )
            assert run["status"] in ("finite", "diverged")
    for file in [
        "identify/identified.json",
        "identify/envelopes.csv",
        "order-sweep/errors.csv",
        "order-sweep/other-rule.csv",
        "random-sum/draws.csv",
        "random-sum/readings.csv",
        "step-sweep/edges.csv",
        "pressure/constants.csv",
        "rdgpi/identified.json",
        "rdgpi/published-parameters.csv",
        "twins/errors.csv",
        "twins/claims.csv",
        "compare/cells.csv",
        "compare/off.csv",
        "compare/claims.csv",
        "compare/audit.csv",
        "compare/summary.json",
        "compare/first.md",
        "compare/margins.csv",
        "compare/verdict.rst",
        "compare/tables/table-1.md",
        "compare/tables/table-4.tex",
        "report.html",
    ]:
        assert (results / file).stat().st_size > 0, file


def test_errors_are_those_of_the_kept_arrays(finished):
    results = finished.folder / "results"
    for signal in ["sine-100hz", "sine-200hz"]:
        d = np.load(results / "records" / f"{signal}.npz")["y"]
        for model in [*FILTERS, "rdgpi"]:
            run = load(results / "filters" / signal / f"{model}.json")
            arrays = np.load(results / "filters" / signal / f"{model}.npz")
            error = d - arrays["output"]
            np.testing.assert_allclose(error, arrays["error"], atol=1e-12)
            assert run["mse"] == pytest.approx(np.mean(error**2), rel=1e-9)
            assert run["re"] == pytest.approx(
                np.sqrt(np.sum(error**2) / np.sum(d**2)), rel=1e-9
            )


def test_the_tables_hold_the_errors_of_the_runs(finished):
    results = finished.folder / "results"
    ran = [
        cell
        for cell in rows(results / "compare" / "cells.csv")
        if cell["metric"] == "mse" and cell["signal"] == "sine-200hz"
    ]
    assert {cell["model"] for cell in ran} == set(FILTERS)
    for cell in ran:
        run = load(results / "filters" / "sine-200hz" / f"{cell['model']}.json")
        assert float(cell["ours"]) == pytest.approx(run["mse"], rel=1e-9)
        assert float(cell["log10_ratio"]) == pytest.approx(
            np.log10(run["mse"] / float(cell["published"])), abs=1e-6
        )


def test_the_twin_says_the_same_in_memory_and_job_by_job(finished):
    results = finished.folder / "results"
    verdicts = {
        row["id"]: row["verdict"] for row in rows(results / "compare" / "claims.csv")
    }
    words = {
        "yes": "reproduced",
        "no": "not reproduced",
        "not testable": "not testable",
    }
    judged = rows(results / "twins" / "claims.csv")
    assert {row["experiment"] for row in judged} == {"0", "1"}
    for row in judged:
        verdict = verdicts[row["claim"]]
        # The ledger is of the configured experiment; the paper's own tables come first.
        if row["experiment"] == "0" and verdict != "refuted by the paper":
            assert verdict == words[row["holds"]], row
    for row in rows(results / "twins" / "errors.csv"):
        run = load(results / "filters" / row["signal"] / f"{row['model']}.json")
        assert float(row["mse"]) == pytest.approx(run["mse"], rel=1e-9)


def test_other_twins_give_each_error_a_spread(workflow, config):
    perturbed = yaml.safe_load(
        (ROOT / "src" / "hystbench" / "plants" / "gma.yaml").read_text()
    )
    gpi = perturbed["chain"][0]["gpi"]
    gpi["weights"] = [1.1 * weight for weight in gpi["weights"]]
    folder = workflow.folder / "twins"
    folder.mkdir()
    (folder / "stronger.yaml").write_text(yaml.safe_dump(perturbed))
    config["pressure"] |= {"twins": ["twins"]}
    workflow.configure(config)
    workflow.run_here("tables")
    cells = rows(workflow.folder / "results" / "compare" / "cells.csv")
    ran = [cell for cell in cells if cell["status"] == "finite"]
    for cell in ran:
        assert float(cell["spread_low"]) <= float(cell["ours"])
        assert float(cell["ours"]) <= float(cell["spread_high"])
    config["pressure"]["twins"] = ["twns"]
    workflow.configure(config)
    assert "pressure: twins: no model or file 'twns'" in workflow.refused()


def test_afterwards_there_is_nothing_to_do(finished):
    assert finished.would_run() == {}


def test_jobs_one_after_the_other_give_the_same_bytes(finished, tmp_path_factory):
    """In one process, where whatever a job leaves behind would reach the next."""
    # As deep as the other: results hold no paths, but rules name sources by them.
    alone = Workflow(tmp_path_factory.mktemp("alone"))
    alone.configure(yaml.safe_load((finished.folder / "config.yaml").read_text()))
    # Figures and the page are held to this by tests of their own.
    alone.run_here("tables", "rdgpi_published")
    drawn = {".png", ".svg", ".html"}
    expected = {
        name: content
        for name, content in finished.files().items()
        if Path(name).suffix not in drawn
    }
    assert alone.files() == expected


def test_one_cell_can_be_made_again_alone(workflow):
    before = workflow.files()
    done = workflow.run("-f", "results/filters/sine-100hz/gpo.json")
    assert done == {"filter": 1}
    assert workflow.files() == before


def assert_one_filter_runs_again(planned):
    """On both signals, and what follows from it."""
    assert planned.pop("filter") == 2
    for rule in ("order_sweep", "random_sum", "step_sweep", "constants"):
        assert planned.pop(rule) == 1
    for rule in ("twin_runs", "twins", "tables", "page"):
        assert planned.pop(rule) == 1
    assert all(name.startswith("draw_") for name in planned)


def test_a_changed_step_size_reruns_its_filter_and_what_follows(workflow, config):
    config["filters"]["convergence_factor"]["delayed"]["mu"] *= 0.5
    workflow.configure(config)
    assert_one_filter_runs_again(workflow.would_run())


def test_a_changed_seed_of_the_noise_reruns_all_from_the_records(workflow, config):
    config["twin"]["seed"] += 1
    workflow.configure(config)
    planned = workflow.would_run()
    assert planned["measure"] == 4
    assert planned["identify"] == 1
    assert "signal" not in planned


def test_a_narrower_config_runs_no_filter_again(workflow):
    planned = workflow.would_run(
        "--config", 'signals=["sine-100hz"]', 'models=["gpo", "delayed"]'
    )
    assert "filter" not in planned
    assert "tables" in planned


def test_an_edited_module_reruns_what_imports_it(workflow):
    source = workflow.folder / "src"
    shutil.copytree(ROOT / "src", source, ignore=shutil.ignore_patterns("__pycache__"))
    copied = Workflow(workflow.folder, source)
    # The same files have other paths here, and are as old as they were.
    by_time = ("--rerun-triggers", "mtime")
    assert copied.would_run(*by_time) == {}
    with (source / "hystbench" / "filters" / "volterra.py").open("a") as stream:
        stream.write("\n# edited\n")
    assert_one_filter_runs_again(copied.would_run(*by_time))


def test_compare_prints_the_tables_though_nothing_is_to_do(finished):
    result = finished.snakemake("compare", "--quiet", "all")
    assert result.returncode == 0, result.stderr
    run = load(finished.folder / "results" / "filters" / "sine-200hz" / "gpo.json")
    assert f"{run['mse']:.4f}" in result.stdout
    assert "0.0221" in result.stdout


def test_a_filter_that_diverges_is_a_visible_entry(workflow, config):
    config["filters"]["convergence_factor"]["delayed"]["mu"] = 50.0
    config["models"] = ["delayed"]
    workflow.configure(config)
    workflow.run_here("tables")
    results = workflow.folder / "results"
    run = load(results / "filters" / "sine-100hz" / "delayed.json")
    assert run["status"] == "diverged"
    assert run["mse"] is None
    assert run["diverged"]["sentence"].startswith("diverged at sample")
    assert "mu = 50 above 1/tr[R] =" in run["diverged"]["sentence"]
    for file in (results / "compare").rglob("*"):
        if file.is_file():
            assert "nan" not in file.read_text().lower().split(), file
    assert "diverged" in (results / "compare" / "tables" / "table-1.md").read_text()


def test_the_report_holds_the_verdict_and_says_twin(finished):
    """Snakemake's own, beside the front page."""
    result = finished.snakemake("--report", "provenance.html")
    assert result.returncode == 0, result.stderr
    text = (finished.folder / "provenance.html").read_text()
    assert "twin" in text
    assert "figure-07-order" in text


def test_the_front_page_shows_what_was_made(finished, browser):
    results = finished.folder / "results"
    assert all_faults(browser, results / "report.html") == []
    about = look(browser, results / "report.html", SIZES[0]).about
    drawn = {
        *(file.stem for file in (results / "figures").glob("*.svg")),
        *(file.stem for file in (results / "identify").glob("*.svg")),
    }
    assert {image["name"] for image in about["images"]} == drawn
    counted = {table["name"]: table["rows"] for table in about["tables"]}
    for name, file in (
        ("claims", "compare/claims.csv"),
        ("audit", "compare/audit.csv"),
        ("envelopes", "identify/envelopes.csv"),
        ("published-parameters", "rdgpi/published-parameters.csv"),
    ):
        assert counted[name] == len(rows(results / file)), name
    for link in about["links"]:
        assert link.startswith("#") or (results / link).is_file(), link


def test_an_edited_caption_makes_the_page_again(workflow, tmp_path):
    """And nothing else; the captions are those of Snakemake's report."""
    shutil.copytree(ROOT / "workflow", workflow.folder / "workflow")
    shutil.copy(ROOT / "Snakefile", workflow.folder)
    own = ("--snakefile", "Snakefile", "--rerun-triggers", "mtime")
    assert workflow.snakemake(*own, "--touch").returncode == 0
    with (workflow.folder / "workflow/report/claims.rst").open("a") as stream:
        stream.write("Edited.\n")
    assert workflow.run(*own) == {"page": 1}
    page = workflow.folder / "results" / "report.html"
    assert "Edited." in page.read_text()


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (("filters", {"ordre": 3}), "unknown key 'ordre'; did you mean 'order'?"),
        (("source", "missing/dataset.yaml"), "missing/dataset.yaml"),
    ],
)
def test_a_bad_config_is_one_line_and_costs_nothing(workflow, config, change, expected):
    key, value = change
    config[key] = config[key] | value if isinstance(value, dict) else value
    workflow.configure(config)
    before = workflow.files()
    assert expected in workflow.refused()
    assert workflow.files() == before


def measured_csv(frequency: float) -> str:
    time = np.arange(800) / 1000
    u = 3 * np.sin(2 * np.pi * frequency * time)
    y = 5 * np.tanh(u) + 0.4 * np.gradient(u)
    rows = [f"{t:.6f},{a:.9g},{b:.9g}" for t, a, b in zip(time, u, y, strict=True)]
    return "\n".join(["time_s,current_A,displacement_um", *rows]) + "\n"


HEADER = """\
name: bench
time: {column: time_s, unit: s}
input: {column: current_A, unit: A}
output: {column: displacement_um, unit: um}
records:
"""


def test_measured_records_go_the_same_way_beside_the_reproduction(
    workflow, write_dataset, browser
):
    # Names that a shell would take apart.
    files = {"slow.csv": measured_csv(2), "it's $HOME.csv": measured_csv(20)}
    records = "".join(f'  - {{file: "{name}"}}\n' for name in files)
    dataset = write_dataset(files, HEADER + records)
    before = workflow.files()
    workflow.run("--config", f"source={dataset}")
    after = workflow.files()
    assert {name: after[name] for name in before} == before
    results = workflow.folder / "results" / "datasets" / "bench"
    for signal in ["slow", "it's $HOME"]:
        for model in [*FILTERS, "rdgpi"]:
            run = load(results / "filters" / signal / f"{model}.json")
            assert run["origin"] == "measured"
    table = (results / "compare" / "tables" / "errors.md").read_text()
    assert "slow" in table
    assert "rdgpi" in table
    assert workflow.would_run("--config", f"source={dataset}") == {}
    page = results / "report.html"
    assert all_faults(browser, page) == []
    about = look(browser, page, SIZES[0]).about
    assert "2 measured records of bench" in about["headline_text"]
    assert {image["name"] for image in about["images"]} == {
        "headline",
        "identification",
        "figure-07-order",
        "learning-curves",
        "loops",
        "errors-by-record",
    }


def test_a_bad_row_of_a_dataset_is_one_line(workflow, write_dataset):
    text = measured_csv(2).splitlines()
    text[50] = "0.049,,3"
    dataset = write_dataset({"slow.csv": "\n".join(text) + "\n"})
    told = workflow.refused("--config", f"source={dataset}")
    assert "slow.csv: row 51: column 'current_A' is 'nan' or empty" in told
    assert not (workflow.folder / "results" / "datasets").exists()
