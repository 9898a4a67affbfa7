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

from tests.conftest import run_hystbench, table
from tests.gap.tiny import LAG_S, LATE, write_tiny

from .conftest import Workflow, small_config

PAGE = "results/gap/tiny/report.html"
GAP = "results/gap/tiny/gap.json"
CHECKED = "results/gap/tiny/stages/checked"


@dataclass
class Finished(Workflow):
    """A folder in which the page was made, and the jobs that made it."""

    done: dict[str, int] = field(default_factory=dict)


RIG = {"dataset": "tiny/dataset/dataset.yaml", "model": "tiny/base.yaml"}
LIMITS = {"low": -0.5, "high": 0.75, "rate": 400}


def configured(folder, config, **rig) -> Workflow:
    workflow = Workflow(folder)
    write_tiny(folder / "tiny")
    config["gap"] |= {"datasets": [RIG | rig]}
    workflow.configure(config)
    return workflow


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    config = small_config()
    config["gap"] |= {"write_experiment": True}
    asked = {"limits": LIMITS, "without": [*LATE.without]}
    workflow = configured(tmp_path_factory.mktemp("whole"), config, **asked)
    return Finished(workflow.folder, done=workflow.run(PAGE))


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
    file = whole.folder / "results/gap/tiny/holdout/unseen.csv"
    measured, before, after = np.loadtxt(file, delimiter=",", skiprows=1)[:, 1:].T
    gap = load(whole)["gap"]
    for key, simulated in (("before", before), ("after", after)):
        rms = np.sqrt(np.mean((measured - simulated) ** 2))
        assert gap[key] == pytest.approx(rms, rel=1e-6)


def test_the_folder_of_the_next_experiment_is_there_though_none_may_be_needed(whole):
    needed = load(whole)["next_experiment"] is not None
    folder = whole.folder / "results/gap/tiny/next-experiment"
    assert [file.name for file in folder.glob("*.csv")] == ["signal.csv"] * needed


def test_what_a_dataset_asks_reaches_its_search(workflow, config):
    """Limits of the next experiment, and effects that are left out and put in."""
    asked = {
        "limits": {"low": -0.15, "rate": 12},
        "without": ["sensor-lag", "input-delay"],
        "with": ["asymmetry"],
    }
    configured(workflow.folder, config, **asked)
    shown = workflow.snakemake(GAP, "--dry-run", "--printshellcmds")
    assert shown.returncode == 0
    told = " ".join((shown.stdout + shown.stderr).split())
    assert "--without sensor-lag --without input-delay --with asymmetry" in told
    assert "--limit-low=-0.15 --limit-rate=12" in told
    # An experiment is written only where it is asked for.
    assert "--write-experiment" not in told


def test_an_effect_that_is_none_is_one_line(workflow, config):
    configured(workflow.folder, config, without=["fricton"])
    assert "no effect 'fricton'; did you mean 'friction'?" in workflow.refused(GAP)


def test_limits_between_which_nothing_lies_are_one_line(workflow, config):
    config["gap"]["twin"] |= {"limits": {"low": 0.4, "high": 0.1}}
    workflow.configure(config)
    told = "gap: twin: limits: low 0.4 and high 0.1; expected low < high"
    assert told in workflow.refused("gap")


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
    assert workflow.refused("gap") == (
        "hystbench: config.yaml: gap: twin: 'sine-100hz' is in fit and in hold_out; "
        "expected it in one of them"
    )


def test_the_examples_dataset_is_made_again_when_a_record_changes_its_role(
    workflow, config
):
    """A record that changes its role is the same input; the dataset is not."""
    config["gap"]["twin"] = {"fit": ["sine-100hz"], "hold_out": ["sine-200hz"]}
    workflow.configure(config)
    dataset = "results/gap/twin/dataset/dataset.yaml"
    assert workflow.run(dataset) == {"gap_twin": 1}
    assert workflow.would_run(dataset) == {}
    config["gap"]["twin"] = {"fit": ["sine-200hz"], "hold_out": ["sine-100hz"]}
    workflow.configure(config)
    planned = workflow.would_run("results/gap/summary.csv")
    assert planned["gap_twin"] == planned["gap_decide"] == 1


def test_the_summary_has_a_row_of_each_gap(whole, tmp_path):
    tables = {key: tmp_path / f"{key}.csv" for key in ("effects", "records", "out")}
    words = [x for key, file in tables.items() for x in (f"--{key}", file)]
    words += ["--sentences", tmp_path / "sentences.csv"]
    done = run_hystbench("job", "gap-summary", whole.folder / GAP, *words)
    assert done.returncode == 0, done.stderr
    (row,) = table(tables["out"])
    content = load(whole)
    assert (row["dataset"], row["verdict"]) == ("tiny", content["verdict"])
    assert float(row["before"]) == pytest.approx(content["gap"]["before"], rel=1e-3)
    names = [item["name"] for item in content["effects"]]
    assert row["effects"] == " + ".join(names)


def test_a_strangers_table_among_hold_out_results_is_refused(whole, tmp_path):
    """Snakemake would remove the whole folder before it shows the records again."""
    shutil.copytree(whole.folder, tmp_path / "copy", symlinks=True)
    workflow = Workflow(tmp_path / "copy")
    mine = workflow.folder / "results/gap/tiny/holdout/notes.csv"
    mine.write_text("mine")
    told = "hystbench: results/gap/tiny/holdout/notes.csv: not written by hystbench"
    assert told in workflow.refused("--forcerun", "gap_show", "--", PAGE)
    assert mine.read_text() == "mine"
    assert (mine.parent / "unseen.csv").is_file()
    mine.unlink()
    assert workflow.run("--forcerun", "gap_show", "--", GAP)["gap_show"] == 1
