"""Whatever a user does wrong ends in one line that says what and where, in status 2.

Each case is a change to a rig that is right (the first test runs it unchanged) and what
the line must name: the file, the key or row, and what was expected.
"""

import os
import shutil
import sys

import numpy as np
import pytest
import yaml

from hystbench import cli
from hystbench.dataset import load_dataset
from hystbench.gap import run as gap_run
from tests.conftest import ROOT

COUNT = 600
DT = 0.001
HEADER = "time_s,current_A,displacement_um"
ABOUT = """name: rig
time: {column: time_s, unit: s}
input: {column: current_A, unit: A}
output: {column: displacement_um, unit: um}
records:
  - {file: one.csv, use: fit}
  - {file: two.csv, use: fit}
  - {file: three.csv, use: hold-out}
"""
MODEL = """name: simulator
input: {name: current, unit: A}
output: {name: displacement, unit: um}
chain:
  - gain: {value: 12.0}
"""
LIE = "the search was started"


@pytest.fixture(scope="module")
def right(tmp_path_factory):
    """Write a rig that is right: a gain, in three records."""
    folder = tmp_path_factory.mktemp("right")
    data = folder / "data"
    data.mkdir()
    rng = np.random.default_rng(0)
    time = np.arange(COUNT) * DT
    for k, name in enumerate(("one", "two", "three")):
        u = (0.5 + 0.1 * k) * np.sin(2 * np.pi * (3 + 2 * k) * time)
        y = 12 * u + 0.02 * rng.standard_normal(COUNT)
        rows = zip(time, u, y, strict=True)
        text = "\n".join([HEADER, *(f"{t:.9g},{a:.9g},{b:.9g}" for t, a, b in rows)])
        (data / f"{name}.csv").write_text(text + "\n")
    (data / "dataset.yaml").write_text(ABOUT)
    (folder / "model.yaml").write_text(MODEL)
    (folder / "bad_fn.py").write_text(
        "import numpy as np\n"
        "def raises(u, dt):\n    raise KeyError('two\\nlines')\n"
        "def short(u, dt):\n    return u[1:]\n"
        "def nan(u, dt):\n    return u * np.nan\n"
        "def complex(u, dt):\n    return u * 1j\n"
        "def leaves(u, dt):\n    raise SystemExit(0)\n"
        "def nothing(u, dt):\n    pass\n"
        "def random(u, dt):\n    return u + np.random.default_rng().random(len(u))\n"
        "def one(u):\n    return u\n"
        "number = 3\n"
    )
    return folder


@pytest.fixture
def rig(right, tmp_path, monkeypatch):
    """Copy it, and make that the folder in which the program is started."""
    shutil.copytree(right, tmp_path / "rig")
    monkeypatch.chdir(tmp_path / "rig")
    monkeypatch.syspath_prepend(str(tmp_path / "rig"))
    sys.modules.pop("bad_fn", None)

    def never(*_, **__):
        raise AssertionError(LIE)

    monkeypatch.setattr(gap_run, "search_and_judge", never)
    return tmp_path / "rig"


def hystbench(monkeypatch, *arguments):
    """Run the program in this process; give its exit status."""
    monkeypatch.setattr(sys, "argv", ["hystbench", *arguments])
    with pytest.raises(SystemExit) as left:
        cli.main()
    return left.value.code or 0


def replaced(file, *pairs):
    """Write other words in a text file."""

    def change(rig):
        text = (rig / file).read_text()
        for old, new in pairs:
            assert old in text
            text = text.replace(old, new, 1)
        (rig / file).write_text(text)

    return change


def about(*pairs):
    return replaced("data/dataset.yaml", *pairs)


def model(*pairs):
    return replaced("model.yaml", *pairs)


def written(file, content):
    """Write a file anew, as text or bytes."""

    def change(rig):
        data = content if isinstance(content, bytes) else content.encode()
        (rig / file).write_bytes(data)

    return change


def row(number, cells, file="data/one.csv"):
    """Write other cells in a row; the header is row 1."""

    def change(rig):
        lines = (rig / file).read_text().splitlines()
        lines[number - 1] = cells
        (rig / file).write_text("\n".join(lines) + "\n")

    return change


def lines(change_lines, file="data/one.csv"):
    """Make other lines of those of a file."""

    def change(rig):
        found = (rig / file).read_text().splitlines()
        (rig / file).write_text("\n".join(change_lines(found)) + "\n")

    return change


def recoded(file, encoding):
    def change(rig):
        (rig / file).write_bytes((rig / file).read_text().encode(encoding))

    return change


def column(place, change_values, file="data/one.csv"):
    """Change the numbers of a column."""

    def change(found):
        cells = [line.split(",") for line in found[1:]]
        values = change_values(np.array([float(each[place]) for each in cells]))
        for each, value in zip(cells, values, strict=True):
            each[place] = f"{value:.12g}"
        return [found[0], *(",".join(each) for each in cells)]

    return lines(change, file)


def folder(path):
    def change(rig):
        (rig / path).unlink(missing_ok=True)
        (rig / path).mkdir()

    return change


def circle(path):
    def change(rig):
        (rig / path).unlink()
        (rig / path).symlink_to(rig / path)

    return change


def copied(source, target):
    def change(rig):
        shutil.copy(rig / source, rig / target)

    return change


def unreadable(path):
    def change(rig):
        (rig / path).chmod(0)
        if os.access(rig / path, os.R_OK):
            pytest.skip("this user may read any file")

    return change


def nothing(rig):
    pass


CHECK = ("job", "gap-check", "data", "--model", "model.yaml")
GAP = ("gap", "data", "--model", "model.yaml", "--out", "out")
LOAD = ("load", "data", "one", "--out", "out")
SIMULATE = ("simulate", "model.yaml", "data/one.csv", "--out", "out")


# Laughs: nine levels of nine aliases each are 400 million items.
LAUGHS = "a: &a [x, x]\n" + "".join(
    f"{b}: &{b} [{', '.join([f'*{a}'] * 9)}]\n"
    for a, b in zip("abcdefgh", "bcdefghi", strict=True)
)
DEEP = "name: " + "[" * 20000 + "]" * 20000
FILE = "one.csv"
YAML = "dataset.yaml"

BAD_RECORDS = {
    "an empty file": (written("data/one.csv", ""), [FILE, "empty", "time_s"]),
    "a header alone": (lines(lambda x: x[:1]), [FILE, "0 rows", "at least 2"]),
    "one row": (lines(lambda x: x[:2]), [FILE, "1 rows", "at least 2"]),
    "binary data": (written("data/one.csv", bytes(range(256))), [FILE, "binary"]),
    "a workbook": (written("data/one.csv", b"PK\x03\x04rest"), [FILE, "workbook"]),
    "decimal commas": (
        lines(lambda x: [x[0], *(line.replace(".", ",") for line in x[1:])]),
        [FILE, "row 2", "4 cells where the header has 3", "decimal commas"],
    ),
    "a ragged row": (row(9, "0.007,1"), [FILE, "row 9", "displacement_um", "empty"]),
    "a long row": (row(9, "0.007,1,2,3"), [FILE, "row 9", "4 cells"]),
    "a number that is none": (row(9, "0.007,1_0,2"), [FILE, "row 9", "'1_0'"]),
    "a word": (row(9, "0.007,off,2"), [FILE, "row 9", "'off'", "a finite number"]),
    "not a number": (row(9, "0.007,nan,2"), [FILE, "row 9", "'nan'"]),
    "infinity": (row(9, "0.007,1,-inf"), [FILE, "row 9", "'-inf'"]),
    "a number too large": (row(9, "0.007,1,1e400"), [FILE, "row 9", "'1e400'"]),
    "a number far too large": (row(9, "0.007,1,1e200"), [FILE, "1e+200"]),
    "a second header": (row(9, HEADER), [FILE, "row 9", "'time_s'"]),
    "a row of other units": (row(2, "s,mA,um"), [FILE, "'A'", "'mA'", "0.001"]),
    "no header": (lines(lambda x: x[1:]), [FILE, "no column 'time_s'"]),
    "a missing column": (row(1, "time_s,current,displacement_um"), [
        FILE, "no column 'current_A'", "did you mean 'current'?"]),
    "a column of other letters": (row(1, "Time_s,current_A,displacement_um"), [
        FILE, "'time_s'", "did you mean 'Time_s'?"]),
    "a column twice": (row(1, "time_s,time_s,displacement_um"), [
        FILE, "2 columns 'time_s'"]),
    "time that goes back": (row(9, "0.001,1,2"), [FILE, "row 9", "increase"]),
    "time that stands": (column(0, lambda t: 0 * t), [FILE, "row 3", "increase"]),
    "a gap in time": (lines(lambda x: [*x[:9], *x[19:]]), [FILE, "row 10", "uniform"]),
    "sampling that is not uniform": (column(0, lambda t: t**2 + t), [FILE, "uniform"]),
    "an input that never moves": (column(1, lambda u: 0 * u + 1), [FILE, "constant"]),
    "a folder": (folder("data/one.csv"), [YAML, "'one.csv' is a folder", "CSV file"]),
    "a link in a circle": (circle("data/one.csv"), [YAML, "no file 'one.csv'"]),
    "no right to read": (unreadable("data/one.csv"), [FILE, "denied"]),
    "too short to fit": (lines(lambda x: x[:9]), [FILE, "8 samples"]),
}  # fmt: skip

CASES = yaml.safe_load((ROOT / "tests" / "bad_inputs.yaml").read_text())
CHANGES = {"about": about, "model": model, "written": written, "recoded": recoded}


def cases(table):
    """Give what changes a file, and the words of the refusal, by the case's name."""
    found = {}
    for name, case in CASES[table].items():
        says = case.pop("says")
        ((how, given),) = case.items()
        found[name] = CHANGES[how](*given), says
    return found


BAD_DATASETS, BAD_MODELS = cases("datasets"), cases("models")
BAD_DATASETS |= {
    "laughs": (about(("name: rig", LAUGHS)), [YAML, "aliases", "100,000"]),
    "depth": (about(("name: rig", DEEP)), [YAML, "line 1", "50 levels"]),
}
BAD_WORDS = {
    name: (case["arguments"], case["says"]) for name, case in CASES["words"].items()
}


def one_line(capsys, words):
    said = capsys.readouterr()
    assert said.err.startswith("hystbench: ")
    assert said.err.endswith("\n")
    assert said.err.count("\n") == 1
    assert len(said.err) < 500
    assert not [word for word in words if word not in said.err], said.err


def test_what_is_right_is_told_so(rig, monkeypatch, capsys):
    """What is refused below is refused for its fault."""
    assert hystbench(monkeypatch, *CHECK) == 0
    said = capsys.readouterr().err
    assert said == "rig: 2 records to fit and 1 held out can be used\n"
    assert hystbench(monkeypatch, *LOAD) == 0
    assert hystbench(monkeypatch, *SIMULATE) == 0
    (rig / "out").unlink()
    assert capsys.readouterr().err == ""
    with pytest.raises(AssertionError, match=LIE):
        hystbench(monkeypatch, *GAP)


@pytest.mark.parametrize(
    "case",
    [
        *(pytest.param(each, id=f"record: {k}") for k, each in BAD_RECORDS.items()),
        *(pytest.param(each, id=f"dataset: {k}") for k, each in BAD_DATASETS.items()),
        *(pytest.param(each, id=f"model: {k}") for k, each in BAD_MODELS.items()),
    ],
)
def test_a_bad_file(rig, monkeypatch, capsys, case):
    change, words = case
    change(rig)
    before = {item for item in rig.rglob("*") if "__pycache__" not in item.parts}
    assert hystbench(monkeypatch, *GAP) == 2
    one_line(capsys, words)
    after = {item for item in rig.rglob("*") if "__pycache__" not in item.parts}
    assert after == before


SAME_RECORDS = {
    "UTF-16": recoded("data/one.csv", "utf-16"),
    "UTF-16 without a mark": recoded("data/one.csv", "utf-16-le"),
    "semicolons": lines(lambda x: [line.replace(",", ";") for line in x]),
    "semicolons and decimal commas": lines(
        lambda x: [line.replace(",", ";").replace(".", ",") for line in x]
    ),
    "tabs": lines(lambda x: [line.replace(",", "\t") for line in x]),
    "a row of units": lines(lambda x: [x[0], "s,A,um", *x[1:]]),
    "comments": lines(lambda x: ["# rig 3", "", "# \u00b5", *x]),
}


@pytest.mark.parametrize("change", SAME_RECORDS.values(), ids=SAME_RECORDS)
def test_another_spelling_of_a_file_is_the_same_record(rig, change):
    before = load_dataset(rig / "data").read("one")
    change(rig)
    after = load_dataset(rig / "data").read("one")
    assert after.dt == before.dt
    np.testing.assert_array_equal(after.u, before.u)
    np.testing.assert_array_equal(after.y, before.y)


@pytest.mark.parametrize("case", BAD_WORDS.values(), ids=BAD_WORDS)
def test_bad_words(rig, monkeypatch, capsys, case):
    arguments, words = case
    (rig / "no.npz").write_text("no archive")
    assert hystbench(monkeypatch, *arguments) == 2
    one_line(capsys, words)
    assert not (rig / "out").exists()


@pytest.mark.parametrize(
    "name", ["decimal commas", "an empty file", "a word", "a gap in time"]
)
@pytest.mark.parametrize("command", [LOAD, SIMULATE], ids=["load", "simulate"])
def test_a_bad_record_of_other_commands(rig, monkeypatch, capsys, command, name):
    change, words = BAD_RECORDS[name]
    change(rig)
    assert hystbench(monkeypatch, *command) == 2
    one_line(capsys, words)
    assert not (rig / "out").exists()
