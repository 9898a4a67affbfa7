"""The folder that a solver gets, the truth that it does not, and the wall between."""

import hashlib
import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from hystbench.challenge.case import make_case
from hystbench.challenge.plant.effects import IN_ACTUATOR
from hystbench.challenge.spec import CaseSpec
from hystbench.commands.hide import hide
from hystbench.dataset import load_dataset
from hystbench.errors import InputError
from hystbench.model import load_model
from hystbench.written import ENTRIES
from tests.challenge.table import markdown_table, markdown_table_of_machines

ROOT = Path(__file__).parents[2]
SPEC = CaseSpec(11, "single", ("thermal-drift",), "gpi", 20.0)


@pytest.fixture(scope="module")
def case():
    return make_case(SPEC)


def asked(place, *words, truth="truth.json"):
    places = ["--out", str(place / "case"), "--truth", str(place / truth)]
    return CliRunner().invoke(hide, [*words, *places])


def hidden(place):
    assert asked(place, "--effect", "thermal-drift", "--seed", "11").exit_code == 0
    return place


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    return hidden(tmp_path_factory.mktemp("case"))


def digest(folder):
    whole = hashlib.sha256()
    for file in sorted(folder.rglob("*")):
        if file.is_file():
            whole.update(str(file.relative_to(folder)).encode() + file.read_bytes())
    return whole.hexdigest()


def test_the_same_spec_writes_the_same_bytes(written, tmp_path):
    assert digest(hidden(tmp_path)) == digest(written)


def test_the_folder_is_a_dataset_and_a_model(written, case):
    dataset = load_dataset(written / "case" / "dataset")
    assert list(dataset.record_files) == [record.name for record in case.records]
    for record in case.records:
        read = dataset.read(record.name)
        assert read.use == record.use
        assert read.dt == pytest.approx(record.dt, rel=1e-6)
        assert (read.u == record.u).all()
        assert read.y == pytest.approx(record.y, abs=1e-9)
        assert (read.input, read.output) == (record.input, record.output)
    assert load_model(written / "case" / "model.yaml") == case.model
    periods = {
        Path(entry["file"]).stem: entry["period_samples"]
        for entry in dataset.about["records"]
        if "period_samples" in entry
    }
    known = {record.name: record.period_samples for record in case.records}
    assert periods == {name: period for name, period in known.items() if period}
    assert dataset.about["input"]["hold"] == "band-limited"


def test_the_truth_is_never_in_the_folder(written):
    truth = json.loads((written / "truth.json").read_text())
    assert truth["effects"][0]["name"] == "thermal-drift"
    files = [
        file
        for file in (written / "case").rglob("*")
        if file.is_file() and ENTRIES not in file.parts
    ]
    names = {file.name for file in files}
    assert names == {"model.yaml", "dataset.yaml", *(n for n in names if ".csv" in n)}
    telling = [
        *IN_ACTUATOR,
        *("joule", "jiles", "preisach", "truth", "seed", "ratio_db", "effect", "noise"),
        *(str(value) for value in truth["effects"][0]["parameters"].values()),
    ]
    for file in files:
        text = file.read_text(encoding="utf-8")
        told = [word for word in telling if word in text]
        # the base may have a mode of its own
        assert set(told) <= {"resonance"}, file


def test_the_truth_may_not_be_put_into_the_folder(tmp_path):
    words = ("--effect", "creep", "--seed", "2")
    done = asked(tmp_path, *words, truth="b/../case/truth.json")
    assert "outside the folder" in str(done.exception)
    assert not (tmp_path / "case").exists()


def test_a_folder_in_use_is_left_alone(tmp_path):
    (tmp_path / "case").mkdir()
    (tmp_path / "case" / "mine.txt").write_text("mine")
    done = asked(tmp_path, "--effect", "creep", "--seed", "2")
    assert "a new or an empty folder" in str(done.exception)
    assert [file.name for file in (tmp_path / "case").iterdir()] == ["mine.txt"]
    assert not (tmp_path / "truth.json").exists()


def test_the_command_hides_nothing_when_asked(tmp_path):
    assert asked(tmp_path, "--kind", "none", "--seed", "2").exit_code == 0
    truth = json.loads((tmp_path / "truth.json").read_text())
    assert (truth["kind"], truth["effects"]) == ("none", [])


def test_the_command_hides_several(tmp_path):
    words = ("--effect", "friction", "--effect", "mains-pickup", "--seed", "2")
    assert asked(tmp_path, *words, "--family", "jiles-atherton").exit_code == 0
    truth = json.loads((tmp_path / "truth.json").read_text())
    names = {effect["name"] for effect in truth["effects"]}
    assert (truth["kind"], names) == ("pair", {"friction", "mains-pickup"})


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--effect", "crepe"), "did you mean 'creep'"),
        ((), "--effect: none given"),
        (("--effect", "creep", "--kind", "pair"), "expected 'single'"),
        (("--kind", "tripel"), "did you mean 'triple'"),
        (("--effect", "creep") * 4, "4 given, expected at most 3"),
    ],
)
def test_the_command_refuses_in_one_line(tmp_path, words, message):
    result = asked(tmp_path, *words, "--seed", "1")
    assert isinstance(result.exception, InputError)
    assert message in str(result.exception)
    assert "\n" not in str(result.exception)
    assert not list(tmp_path.iterdir())


def contracts(folder):
    """Run the import contracts on a copy of the package."""
    lint = Path(sys.executable).with_name("lint-imports")
    return subprocess.run(
        [str(lint), "--no-cache"],
        cwd=folder,
        env={"PYTHONPATH": str(folder / "src")},
        capture_output=True,
        text=True,
    )


@pytest.mark.parametrize(
    ("file", "line", "broken"),
    [
        ("gap/__init__.py", "", ""),
        (
            "gap/__init__.py",
            "from hystbench.challenge.case import make_case\n",
            "Nobody but its commands knows the challenge",
        ),
        (
            "commands/gap.py",
            "from hystbench.challenge.case import make_case\n",
            "Nobody but its commands knows the challenge",
        ),
        (
            "challenge/plant/peek.py",
            "import hystbench.operators\n",
            "The hiding plant shares no code with the models",
        ),
    ],
)
def test_the_wall_holds_when_tried(tmp_path, file, line, broken):
    package = tmp_path / "src" / "hystbench"
    shutil.copytree(
        ROOT / "src" / "hystbench",
        package,
        ignore=shutil.ignore_patterns("*.so", "__pycache__", "*.csv"),
    )
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    tried = package / file
    before = tried.read_text() if tried.exists() else ""
    tried.write_text(before + line)
    result = contracts(tmp_path)
    found = [row for row in result.stdout.splitlines() if row.endswith("BROKEN")]
    assert found == ([f"{broken} BROKEN"] if broken else []), result.stdout
    assert result.returncode == (1 if broken else 0)


def test_the_page_holds_the_table_of_ranges():
    # To write it: python -c 'from tests.challenge.table import *;
    # print(markdown_table(), end="")' and paste it between the two comments.
    page = (ROOT / "docs" / "challenge.md").read_text(encoding="utf-8")
    assert f"<!-- ranges -->\n\n{markdown_table()}\n<!-- end of ranges -->" in page
    machines = markdown_table_of_machines()
    assert f"<!-- machines -->\n\n{machines}\n<!-- end of machines -->" in page


def test_the_table_tells_a_limit_on_one_side_and_on_both():
    """The sensor's gap cannot be shorter than what moves in it, 90 um."""
    (gap,) = (row for row in markdown_table().splitlines() if "`gap`" in row)
    assert gap.split("|")[7].strip() == "90 or more"
    (lag,) = (row for row in markdown_table().splitlines() if "`sensor-lag`" in row)
    assert lag.split("|")[7].strip() == "5e-05 to 0.03"


def test_rows_are_written_as_numpy_would(written, case):
    table = np.loadtxt(
        written / "case" / "dataset" / "long.csv", delimiter=",", skiprows=1
    )
    (record,) = [record for record in case.records if record.name == "long"]
    assert table[:, 0] == pytest.approx(record.time, abs=5e-7)
    assert (table[:, 1] == record.u).all()
