"""The package that docs/extending.md walks through: installed, and run."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
import yaml

from hystbench.challenge.contest.plan import plan
from tests.conftest import table as rows
from tests.docs.pages import ROOT
from tests.gap.searched import among
from tests.gap.tiny import write_driven

from .conftest import Workflow, small_config

PAGE = (ROOT / "docs" / "extending.md").read_text(encoding="utf-8")
#: A file of the page: its name, and what stands in the fence below.
FILE = re.compile(r"^`([\w./]+)`:\n\n```\w+\n(.*?)^```", re.MULTILINE | re.DOTALL)
CONFIG = re.compile(r"^```yaml\n(.*?)^```", re.MULTILINE | re.DOTALL)

FIGURES = [
    f"results/figures/{name}.svg"
    for name in ("figure-07-order", "learning-curves", "step-edges")
]
TARGETS = ["tables", *FIGURES]
CYLINDER = {"dataset": "cylinder/dataset", "model": "cylinder/base.yaml"}
LIKELY = among("asymmetry", "calibration-error", "dead-zone", "drive-saturation")
"""What a gain that is less one way may be taken for, beside the package's effect."""


def merged(one: dict, other: dict) -> dict:
    """Put the keys of a config into another, at any depth."""
    both = dict(one)
    for key, value in other.items():
        inner = isinstance(value, dict) and isinstance(both.get(key), dict)
        both[key] = merged(both[key], value) if inner else value
    return both


def install(folder: Path, files: dict[str, str]) -> None:
    """Lay files out as an installed package, with the entry points they declare."""
    for name, content in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(content, encoding="utf-8")
    project = tomllib.loads(files["pyproject.toml"])["project"]
    told = folder / f"{project['name']}-{project['version']}.dist-info"
    told.mkdir()
    (told / "METADATA").write_text(
        f"Metadata-Version: 2.1\nName: {project['name']}\n"
        f"Version: {project['version']}\n"
    )
    lines = []
    for group, points in project["entry-points"].items():
        lines += [f"[{group}]", *(f"{name} = {to}" for name, to in points.items())]
    (told / "entry_points.txt").write_text("\n".join(lines) + "\n")


@pytest.fixture(scope="module")
def configured(tmp_path_factory) -> Workflow:
    """A folder with the page's config, in which the page's package is installed."""
    package = tmp_path_factory.mktemp("installed")
    install(package, dict(FILE.findall(PAGE)))
    config = small_config()
    for text in CONFIG.findall(PAGE):
        config = merged(config, yaml.safe_load(text))
    # The page's own solvers alone: those that hystbench has are entered elsewhere.
    solvers = config["blind"]["solvers"]
    config["blind"]["solvers"] = {x: solvers[x] for x in ("silent", "one-gain")}
    config["blind"]["only"] = ["saturation"]
    workflow = Workflow(tmp_path_factory.mktemp("extended"), package)
    # A cylinder that loses 15 % of its force where it pulls.
    write_driven(
        workflow.folder / "cylinder",
        lambda u: np.where(u < 0, 0.85 * u, u),
        "device: {kind: hydraulic}\n",
    )
    config["gap"]["datasets"] = [CYLINDER | {"without": [*LIKELY.without]}]
    workflow.configure(config)
    return workflow


@pytest.fixture(scope="module")
def extended(configured) -> Workflow:
    """The folder in which the config has run."""
    assert configured.run(*TARGETS)
    return configured


def test_the_filter_and_the_signal_are_in_tables_and_figures(extended):
    results = extended.folder / "results"
    found = {
        (row["signal"], row["model"]) for row in rows(results / "compare" / "added.csv")
    }
    assert found == {
        ("sine-100hz", "power"),
        *(("triangle-050hz", model) for model in ("delayed", "power")),
    }
    by_order = rows(results / "order-sweep" / "errors.csv")
    assert "power" in {row["model"] for row in by_order}
    edges = rows(results / "step-sweep" / "edges.csv")
    assert "power" in {row["model"] for row in edges}
    for name in FIGURES:
        assert "power filter" in (extended.folder / name).read_text(), name
    printed = (results / "compare" / "tables.txt").read_text()
    assert "The paper has no numbers for power, triangle-050hz." in printed


def test_they_compute_what_the_page_says(extended):
    """From the definitions alone, sample by sample."""
    results = extended.folder / "results"
    u = np.load(results / "signals" / "triangle-050hz.npz")["u"]
    # A quarter of a period of 20 ms after the start it is at its top.
    assert u[0] == 0
    assert np.argmax(u[:200]) == 50
    assert u.max() == pytest.approx(0.632)
    np.testing.assert_allclose(np.diff(u[:50], 2), 0, atol=1e-12)
    record = np.load(results / "records" / "triangle-050hz.npz")
    run = json.loads((results / "filters/triangle-050hz/power.json").read_text())
    order, mu = run["order"], run["step_size"]["mu"]
    assert mu == 0.02
    line = np.concatenate((np.zeros(order), record["u"]))
    weights, errors = np.zeros(order + 1), []
    for k, d in enumerate(record["y"]):
        taps = line[k : k + order + 1][::-1]
        h = np.sign(taps) * np.abs(taps) ** 1.5
        errors.append(d - weights @ h)
        weights = weights + 2 * mu * errors[-1] * h
    assert run["mse"] == pytest.approx(np.mean(np.square(errors)), rel=1e-9)


def test_the_solvers_enter_the_contest_with_the_names_they_know(configured):
    assert configured.run("results/blind/summary.json")
    folder = configured.folder / "results" / "blind"
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["cases"] == len(plan("small", only=["saturation"])) > 0
    assert summary["lost"] == 0
    cases = {case["solver"]: case for case in rows(folder / "cases.csv")}
    silent, one_gain = cases.pop("silent"), cases.pop("one-gain")
    assert cases == {}
    assert (silent["truth"], silent["verdict"], silent["named"]) == (
        *("saturation", "no-gap", ""),
    )
    # A saturation lowers the gain, and of names this solver knows no other.
    assert (one_gain["named"], one_gain["top1"]) == ("calibration-error", "False")
    assert one_gain["confidence"] == "0.5"


def test_an_edited_solver_answers_again(configured):
    target = "results/blind/summary.json"
    configured.run(target)
    assert configured.would_run(target, "--rerun-triggers", "mtime") == {}
    file = configured.packages / "extra" / "one_gain.py"
    file.write_text(file.read_text() + "\n# edited\n")
    planned = configured.would_run(target, "--rerun-triggers", "mtime")
    assert "blind_solve" in planned


@pytest.fixture(scope="module")
def searched(configured) -> Workflow:
    """The folder in which the gap of the cylinder was searched."""
    assert configured.run("results/gap/tiny/report.html")
    return configured


def test_the_effect_is_named_with_its_causes_in_such_a_device(searched):
    folder = searched.folder / "results" / "gap" / "tiny"
    gap = json.loads((folder / "gap.json").read_text())
    assert gap["verdict"] == "named"
    (effect,) = gap["effects"]
    assert effect["name"] == "unequal-gain"
    assert effect["behaviour"] == "unequal gain"
    assert effect["causes"] == ["a cylinder with a rod on one side"]
    share = effect["parameters"]["share"]
    assert share["value"] == pytest.approx(0.15, abs=3 * share["standard_error"])
    assert share["standard_error"] < 0.01
    assert gap["ranking"][0]["name"] == "unequal-gain"
    assert gap["gap"]["explained"] > 0.99
    chain = yaml.safe_load((folder / "model.yaml").read_text())["chain"]
    assert [next(iter(item)) for item in chain] == ["unequal-gain", "gpi"]
    page = (folder / "report.html").read_text()
    said = "Unequal gain: in a device that is hydraulic a cylinder with a rod"
    assert said in page


def test_an_edited_effect_is_searched_again(searched):
    target = "results/gap/tiny/gap.json"
    assert searched.would_run(target) == {}
    file = searched.packages / "extra" / "unequal_gain_effect.py"
    file.write_text(file.read_text() + "\n# edited\n")
    planned = searched.would_run(target, "--rerun-triggers", "mtime")
    assert set(planned) == {"gap_decide", "gap_show"}


def test_all_of_the_package_keeps_the_contracts(configured):
    """Those that hystbench's own filters, signals, blocks, effects and solvers keep."""
    path = map(str, filter(None, (configured.packages, os.environ.get("PYTHONPATH"))))
    files = ("blocks/test_contract.py", "gap/effects/test_effects.py")
    contracts = ("test_registered.py", *files)
    ran = subprocess.run(
        [
            *(sys.executable, "-m", "pytest", "-v", "-p", "no:cacheprovider"),
            *("-k", "power or triangle or unequal or one-gain"),
            *(f"tests/{name}" for name in contracts),
        ],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(path)},
        capture_output=True,
        text=True,
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
    for contract in (
        "test_a_filter_is_the_lms_of_its_regressor",
        "test_a_waveform_makes_its_example[triangle]",
        "test_a_solver_writes_a_gap_json_that_keeps_the_schema[one-gain]",
        "test_it_is_causal[unequal-gain]",
        "test_a_variant_builds_a_model_that_runs",
        "test_bounds_come_from_the_records_alone[unequal-gain]",
    ):
        assert contract in ran.stdout


def test_an_edited_file_of_the_package_runs_its_filter_again(extended):
    file = extended.packages / "extra" / "power.py"
    assert extended.would_run(*TARGETS) == {}
    file.write_text(file.read_text() + "\n# edited\n")
    planned = extended.would_run(*TARGETS, "--rerun-triggers", "mtime")
    assert planned["filter"] == 2
    assert "signal" not in planned


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        (
            "models",
            ["delayed", "powr"],
            "models: 1: 'powr' is unknown; did you mean 'power'?",
        ),
        ("filters", {"power_exponent": 99}, "power_exponent: 99; expected a number of"),
        (
            "filters",
            {"power_exponnt": 2.0},
            "unknown key 'power_exponnt'; did you mean 'power_exponent'?",
        ),
        (
            "excitations",
            {"other": {"triangel": {"frequency_hz": 50}}},
            "unknown kind 'triangel'; did you mean 'triangle'?",
        ),
        (
            "gap",
            {"datasets": [{**CYLINDER, "without": ["unequal-gian"]}]},
            "no effect 'unequal-gian'; did you mean 'unequal-gain'?",
        ),
    ],
)
def test_a_mistake_is_one_line_with_the_nearest_name(extended, key, value, said):
    config = yaml.safe_load((extended.folder / "config.yaml").read_text())
    (extended.folder / "wrong.yaml").write_text(
        yaml.safe_dump(merged(config, {key: value}))
    )
    assert said in extended.refused("-n", "--configfile", "wrong.yaml")
