"""Slurm's test: what counts as the same results, and what it runs on."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from hystbench.challenge.contest.plan import chunks, plan
from hystbench.settings import read_settings
from hystbench.yaml_files import load_yaml

ROOT = Path(__file__).parents[2]
SCRIPTS = ROOT / "profiles" / "slurm" / "test"


def compared(one, other):
    words = [sys.executable, str(SCRIPTS / "same.py"), str(one), str(other)]
    return subprocess.run(words, capture_output=True, text=True, check=False)


@pytest.fixture
def folders(tmp_path):
    one, other = tmp_path / "one", tmp_path / "other"
    (one / "logs").mkdir(parents=True)
    (one / "answers").mkdir()
    answer = {"cases": [{"case": "a", "seconds": 1.5, "named": "creep"}]}
    (one / "answers" / "a.json").write_text(json.dumps(answer))
    (one / "cases.csv").write_text("case,cpu_seconds,named\na,1.5,creep\n")
    (one / "reach.csv").write_text("figure,reached\ntop1,0.9\nseconds_per_case,1.5\n")
    (one / "figure.png").write_bytes(b"picture 1.5")
    (one / "logs" / "a.log").write_text("1.5")
    shutil.copytree(one, other)
    return one, other


def edit(folder, name, old, new):
    path = folder / name
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


def test_times_and_logs_may_differ(folders):
    for name in ("answers/a.json", "cases.csv", "reach.csv", "logs/a.log"):
        edit(folders[1], name, "1.5", "2.5")
    done = compared(*folders)
    assert (done.returncode, done.stdout) == (0, "4 files, the same in both\n")


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("answers/a.json", "creep", "drift"),
        ("cases.csv", "creep", "drift"),
        ("reach.csv", "0.9", "0.8"),
        ("figure.png", "1.5", "2.5"),
    ],
)
def test_another_result_is_told(folders, name, old, new):
    edit(folders[1], name, old, new)
    done = compared(*folders)
    assert (done.returncode, done.stderr) == (1, f"{name}: not the same\n")


def test_a_key_that_is_no_time_is_compared(folders):
    for folder, duration in zip(folders, (1, 2), strict=True):
        (folder / "plan.json").write_text(json.dumps({"seconds_asked": duration}))
        (folder / "limits.csv").write_text(
            f"figure,reached\nseconds_limit,{duration}\n"
        )
    done = compared(*folders)
    told = "limits.csv: not the same\nplan.json: not the same\n"
    assert (done.returncode, done.stderr) == (1, told)


def test_two_files_are_compared(folders):
    one, other = (folder / "cases.csv" for folder in folders)
    edit(folders[1], "cases.csv", "1.5", "2.5")
    assert compared(one, other).returncode == 0
    edit(folders[1], "cases.csv", "creep", "drift")
    assert compared(one, other).returncode == 1


def test_a_file_that_one_lacks_is_told(folders):
    (folders[0] / "cases.csv").unlink()
    done = compared(*folders)
    assert (done.returncode, done.stderr) == (1, "cases.csv: not the same\n")


def test_nothing_is_not_the_same_as_nothing(tmp_path):
    assert compared(tmp_path, tmp_path).returncode == 1


def test_it_runs_three_signals_and_24_blind_cases_in_four_jobs(tmp_path):
    config = tmp_path / "config.yaml"
    words = [str(SCRIPTS / "small.py"), str(ROOT / "config.yaml"), str(config)]
    subprocess.run([sys.executable, *words], check=True)
    small = load_yaml(config)
    # The workflow takes it: no key that it does not know.
    read_settings(small, ROOT / "workflow" / "schemas" / "config.schema.yaml")
    assert len(small["signals"]) == 3
    blind = small["blind"]
    entries = plan(blind["set"], blind["scale"])
    assert len(entries) == 24
    assert len(chunks(entries, blind["chunk"])) == 4
    assert list(blind["solvers"]) == [blind["solver"]]
