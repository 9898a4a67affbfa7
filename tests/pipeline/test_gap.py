"""The gap through Snakemake, and what runs again."""

from __future__ import annotations

import csv
import io
import json
import os
import shutil
from dataclasses import dataclass, field

import numpy as np
import pytest

from tests.gap.small import write_lagging
from tests.gap.tiny import LAG_S, write_tiny

from .conftest import Workflow, small_config

PAGE = "results/gap/tiny/report.html"
GAP = "results/gap/tiny/gap.json"
CHECKED = "results/gap/tiny/stages/checked"


@dataclass
class Finished(Workflow):
    """A folder in which the page was made, and the jobs that made it."""

    done: dict[str, int] = field(default_factory=dict)


def configured(folder, config) -> Workflow:
    workflow = Workflow(folder)
    write_tiny(folder / "tiny")
    config["gap"] |= {
        "datasets": [
            {"dataset": "tiny/dataset/dataset.yaml", "model": "tiny/base.yaml"}
        ],
    }
    workflow.configure(config)
    return workflow


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    workflow = configured(tmp_path_factory.mktemp("whole"), small_config())
    return Finished(workflow.folder, workflow.environment, workflow.run(PAGE))


def load(workflow):
    return json.loads((workflow.folder / GAP).read_text())


def test_one_job_names_the_lag_and_closes_the_gap(whole):
    assert whole.done == {
        "gap_check": 1,
        "gap_decide": 1,
        "gap_show": 1,
        "gap_report": 1,
    }
    content = load(whole)
    assert content["verdict"] == "named"
    (effect,) = content["effects"]
    assert effect["name"] == "drive-lag"
    assert effect["parameters"]["time_constant_s"]["value"] == pytest.approx(
        LAG_S, rel=0.02
    )
    assert content["gap"]["after"] < 0.1 * content["gap"]["before"]
    assert (whole.folder / PAGE).read_text().startswith("<!")


def test_gap_json_holds_the_rms_of_the_hold_out_record(whole):
    table = np.loadtxt(
        whole.folder / "results/gap/tiny/holdout/unseen.csv",
        delimiter=",",
        skiprows=1,
    )
    measured, before, after = table[:, 1:].T
    gap = load(whole)["gap"]
    for key, simulated in (("before", before), ("after", after)):
        rms = np.sqrt(np.mean((measured - simulated) ** 2))
        assert gap[key] == pytest.approx(rms, rel=1e-6)


def test_the_next_experiment_is_written_within_the_limits_of_its_dataset(
    tmp_path, config
):
    """Only where it is asked for; the folder is there though none may be needed."""
    workflow = Workflow(tmp_path)
    write_lagging(tmp_path)
    rig = {"dataset": "rig/dataset.yaml", "model": "base.yaml"}
    limits = {"low": -0.15, "high": 0.35, "rate": 12}
    config["gap"] |= {"datasets": [rig | {"limits": limits}], "write_experiment": True}
    workflow.configure(config)
    workflow.run("results/gap/made/next-experiment")
    file = tmp_path / "results/gap/made/next-experiment/signal.csv"
    time, u = np.loadtxt(file, delimiter=",", skiprows=1).T
    assert limits["low"] - 1e-6 <= u.min() < u.max() <= limits["high"] + 1e-6
    rates = np.abs(np.diff(u)) / np.diff(time)
    assert rates.max() <= limits["rate"] * (1 + 1e-4)
    config["gap"] |= {"datasets": [rig], "write_experiment": False}
    workflow.configure(config)
    asked = workflow.snakemake("results/gap/made/next-experiment", "--dry-run")
    assert asked.returncode != 0


def test_effects_that_a_dataset_leaves_out_and_puts_in_reach_its_search(
    workflow, config
):
    write_tiny(workflow.folder / "tiny")
    rig = {"dataset": "tiny/dataset/dataset.yaml", "model": "tiny/base.yaml"}
    asked = {"without": ["sensor-lag", "input-delay"], "with": ["asymmetry"]}
    config["gap"] |= {"datasets": [rig | asked]}
    workflow.configure(config)
    shown = workflow.snakemake(GAP, "--dry-run", "--printshellcmds")
    assert shown.returncode == 0
    told = " ".join((shown.stdout + shown.stderr).split())
    assert "--without sensor-lag --without input-delay --with asymmetry" in told


def test_an_effect_that_is_none_is_one_line(workflow, config):
    write_tiny(workflow.folder / "tiny")
    rig = {"dataset": "tiny/dataset/dataset.yaml", "model": "tiny/base.yaml"}
    config["gap"] |= {"datasets": [rig | {"without": ["fricton"]}]}
    workflow.configure(config)
    refused = workflow.snakemake(GAP)
    assert refused.returncode != 0
    told = "no effect 'fricton'; did you mean 'friction'?"
    assert told in refused.stdout + refused.stderr
    assert "Traceback" not in refused.stderr


def test_limits_between_which_nothing_lies_are_one_line(workflow, config):
    config["gap"]["twin"] |= {"limits": {"low": 0.4, "high": 0.1}}
    workflow.configure(config)
    refused = workflow.snakemake("gap")
    assert refused.returncode != 0
    told = "gap: twin: limits: low 0.4 and high 0.1; expected low < high"
    assert told in refused.stdout + refused.stderr


READ_HOLD_OUT = {"gap_check", "gap_show"}
"""Rules that may have hold-out files for inputs."""
DECIDE = "gap_decide"


HELD_OUT = "tiny/dataset/unseen.csv"


@dataclass(frozen=True)
class Made:
    """A file, the rule that made it, and the inputs that its job had."""

    file: str
    rule: str
    input: frozenset[str]


def made(workflow, target) -> list[Made]:
    """Give all files that a target depends on, as Snakemake recorded them."""
    result = workflow.snakemake("--detailed-summary", target)
    assert result.returncode == 0, result.stderr
    return [
        Made(
            row["output_file"],
            row["rule"],
            frozenset(row["input-file(s)"].split(",")),
        )
        for row in csv.DictReader(io.StringIO(result.stdout), delimiter="\t")
    ]


def upstream(files: list[Made], one: Made) -> set[str]:
    """Name all files that a file depends on, near and far."""
    inputs = {item.file: item.input for item in files}
    found, waiting = set(), set(one.input)
    while waiting:
        found |= waiting
        waiting = set().union(*(inputs.get(name, ()) for name in waiting)) - found
    return found


def test_hold_out_files_are_never_upstream_of_what_decides(whole):
    files = made(whole, PAGE)
    assert {item.rule for item in files if HELD_OUT in item.input} == READ_HOLD_OUT
    decided = [item for item in files if item.rule == DECIDE]
    assert decided
    for item in decided:
        behind = upstream(files, item)
        assert "tiny/dataset/slow.csv" in behind
        assert not behind & {HELD_OUT, CHECKED}, item.file
    (gap,) = (item for item in files if item.file == GAP)
    assert {HELD_OUT, CHECKED} <= gap.input


def test_an_edited_hold_out_record_is_checked_and_shown_again(whole):
    workflow = whole
    data = workflow.folder / "tiny" / "dataset"
    kept = (data / "unseen.csv").stat()
    edit(data / "unseen.csv")
    again = {"gap_check": 1, "gap_show": 1, "gap_report": 1}
    assert workflow.would_run(PAGE) == again
    os.utime(data / "unseen.csv", ns=(kept.st_atime_ns, kept.st_mtime_ns))
    kept = (data / "slow.csv").stat()
    edit(data / "slow.csv")
    assert DECIDE in workflow.would_run(PAGE)
    os.utime(data / "slow.csv", ns=(kept.st_atime_ns, kept.st_mtime_ns))


def test_a_check_leaves_nothing_of_the_hold_out_records(whole):
    assert (whole.folder / CHECKED).read_bytes() == b""


def test_a_bad_hold_out_file_stops_the_run_before_the_search(tmp_path, config):
    workflow = configured(tmp_path, config)
    file = tmp_path / "tiny" / "dataset" / "unseen.csv"
    lines = file.read_text().splitlines()
    lines[8] = "0.0014,nan,1"
    file.write_text("\n".join(lines) + "\n")
    # On one core what has priority comes first.
    result = workflow.snakemake(PAGE, "--cores", "1")
    assert result.returncode != 0
    told = "unseen.csv: row 9: column 'current_A' is 'nan' or empty; expected"
    assert told in result.stdout + result.stderr
    stages = tmp_path / "results/gap/tiny/stages"
    assert not [path for path in stages.rglob("*") if path.is_file()]


def test_an_edited_simulator_is_tried_again(tmp_path, config):
    workflow = configured(tmp_path, config)
    (tmp_path / "rig.py").write_text("def run(u, dt):\n    return 2 * u\n")
    (about,) = config["gap"]["datasets"]
    about["model"] = "rig:run"
    workflow.configure(config)
    # The quick one of the two jobs that run it: both have the same inputs of it.
    assert workflow.run(CHECKED) == {"gap_check": 1}
    assert workflow.would_run(CHECKED) == {}
    edit(tmp_path / "rig.py")
    assert workflow.would_run(CHECKED) == {"gap_check": 1}


def edit(file):
    """Change a file; an empty line changes no sample."""
    file.write_text(file.read_text() + "\n")


def test_the_worked_example_is_planned_from_the_twin(workflow):
    planned = workflow.would_run("gap")
    assert planned["gap_twin"] == 1
    assert planned["gap_summary"] == 1
    assert planned["gap_show"] == 1


def test_a_signal_in_both_roles_is_one_line(workflow, config):
    config["gap"]["twin"] = {"fit": ["sine-100hz"], "hold_out": ["sine-100hz"]}
    workflow.configure(config)
    refused = workflow.snakemake("gap")
    assert refused.returncode != 0
    assert (
        "hystbench: config.yaml: gap: twin: 'sine-100hz' is in fit and in hold_out; "
        "expected it in one of them"
    ) in refused.stderr.splitlines()


def test_the_example_runs_from_identification_to_summary(workflow, config):
    config["gap"]["twin"] = {"fit": ["sine-100hz"], "hold_out": ["sine-200hz"]}
    workflow.configure(config)
    workflow.run("results/gap/summary.csv")
    gap = workflow.folder / "results" / "gap"
    with (gap / "summary.csv").open(newline="") as stream:
        (row,) = csv.DictReader(stream)
    content = json.loads((gap / "twin" / "gap.json").read_text())
    assert (row["dataset"], row["verdict"]) == ("twin", content["verdict"])
    assert float(row["before"]) == pytest.approx(content["gap"]["before"], rel=1e-3)
    names = [item["name"] for item in content["effects"]]
    assert row["effects"] == (" + ".join(names) or "none")
    # A record that changes its role is the same input; the dataset is not.
    assert workflow.would_run("results/gap/summary.csv") == {}
    config["gap"]["twin"] = {"fit": ["sine-200hz"], "hold_out": ["sine-100hz"]}
    workflow.configure(config)
    planned = workflow.would_run("results/gap/summary.csv")
    assert planned["gap_twin"] == planned["gap_decide"] == 1


def test_a_strangers_table_among_hold_out_results_is_refused(whole, tmp_path):
    """Snakemake would remove the whole folder before it shows the records again."""
    shutil.copytree(whole.folder, tmp_path / "copy", symlinks=True)
    workflow = Workflow(tmp_path / "copy")
    mine = workflow.folder / "results/gap/tiny/holdout/notes.csv"
    mine.write_text("mine")
    result = workflow.snakemake("--forcerun", "gap_show", "--", PAGE)
    assert result.returncode != 0
    told = "hystbench: results/gap/tiny/holdout/notes.csv: not written by hystbench"
    assert told in result.stdout + result.stderr
    assert mine.read_text() == "mine"
    assert (mine.parent / "unseen.csv").is_file()
    mine.unlink()
    assert workflow.run("--forcerun", "gap_show", "--", GAP)["gap_show"] == 1
