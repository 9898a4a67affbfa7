"""Whatever a user does wrong ends in one line that says what and where, in status 2.

Each case is a change to a rig that is right (the first test runs it unchanged) and what
the line must name: the file, the key or row, and what was expected.
"""

import os
import shutil
import sys

import numpy as np
import pytest

from hystbench import cli
from hystbench.dataset import load_dataset
from hystbench.gap import run as gap_run

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

    monkeypatch.setattr(gap_run, "find", never)
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


def base(word):
    return (*CHECK[:-1], word)


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

BAD_DATASETS = {
    "a list": (written("data/dataset.yaml", "- a\n- b\n"), [YAML, "expected"]),
    "nothing": (written("data/dataset.yaml", ""), [YAML, "expected a dataset.yaml"]),
    "two documents": (about(("records", "---\nrecords")), [YAML, "line 5", "document"]),
    "a tab": (about(("  - {file: one", "\t- {file: one")), [YAML, "line 6", "a tab"]),
    "no end": (about(("unit: s}", "unit: s")), [YAML, "line"]),
    "UTF-16": (recoded("data/dataset.yaml", "utf-16"), [YAML, "UTF-16"]),
    "a key twice": (
        about(("name: rig", "name: rig\nname: rig2")),
        [YAML, "line 2", "'name'", "line 1 already", "once"],
    ),
    "a key twice inside": (
        about(("unit: um", "unit: um, unit: mm")),
        [YAML, "line 4", "'unit'", "once"],
    ),
    "laughs": (about(("name: rig", LAUGHS)), [YAML, "aliases", "100,000"]),
    "anchors in a circle": (
        about(("name: rig", "name: &a [*a]")),
        [YAML, "line 1", "'*a' inside of what it names"],
    ),
    "depth": (about(("name: rig", DEEP)), [YAML, "line 1", "50 levels"]),
    "a tag": (
        about(("name: rig", "name: !!python/object/apply:os.system ['touch pwned']")),
        [YAML, "line 1", "a tag", "expected plain text"],
    ),
    "a key that is a list": (about(("name: rig", "[a]: rig")), [YAML, "line 1", "key"]),
    "a date that is none": (about(("name: rig", "name: 2024-13-45")), [YAML, "month"]),
    "a misspelt key": (
        about(("records", "recrods")),
        [YAML, "did you mean 'records'?"],
    ),
    "a misspelt role": (
        about(("hold-out", "holdout")),
        [YAML, "records: 2: use", "did you mean 'hold-out'?"],
    ),
    "a number for a name": (
        about(("name: rig", "name: 12")),
        [YAML, "name: 12", "word"],
    ),
    "a record twice": (
        about(("file: two.csv", "file: one.csv")),
        [YAML, "'one.csv'", "twice"],
    ),
    "two records of one name": (
        about(("file: two.csv", "file: sub/one.csv")),
        [YAML, "'sub/one.csv'", "both named 'one'"],
    ),
    "a file that is not there": (
        about(("file: two.csv", "file: tow.csv")),
        [YAML, "no file 'tow.csv'", "did you mean 'two.csv'?"],
    ),
    "a path out of the folder": (
        about(("file: two.csv", "file: ../two.csv")),
        [YAML, "no file '../two.csv'", "expected a CSV file", "has none"],
    ),
    "a folder that is not there": (
        about(("file: two.csv", "file: sub/two.csv")),
        [YAML, "no file 'sub/two.csv'", "no folder 'data/sub'"],
    ),
    "a file without a name": (about(("file: two.csv", "file: ..")), [YAML, "'..'"]),
    "a name with braces": (
        about(("file: two.csv", "file: '{two}.csv'")),
        [YAML, "{two}.csv", "a name that begins with a letter or digit"],
    ),
    "a number for a file": (about(("file: two.csv", "file: 2")), [YAML, "1: file: 2"]),
    "no record": (
        about(("records:\n", "records: []\nx:\n")),
        [YAML, "unknown key 'x'"],
    ),
    "none held out": (about(("hold-out", "fit")), [YAML, "none has 'use: hold-out'"]),
    "all held out": (
        about(*2 * [("use: fit", "use: hold-out")]),
        [YAML, "at least one with 'use: fit'"],
    ),
    "two columns of time": (
        about(("column: current_A", "column: time_s")),
        [YAML, "'time_s' is named twice"],
    ),
    "a unit that is none": (
        about(("unit: A", "unit: Ampere")),
        [YAML, "input: unit: 'Ampere'", "did you mean 'ampere'?", "'-'"],
    ),
    "a unit of other letters": (
        about(("unit: um", "unit: UM")),
        [YAML, "output: unit", "did you mean 'um'?"],
    ),
    "a unit that would be worked out for ever": (
        about(("unit: um", "unit: m**9**9**9")),
        [YAML, "'m**9**9**9' is no unit"],
    ),
    "a unit with a factor": (about(("unit: um", "unit: 0.1 mm")), [YAML, "'0.1 mm'"]),
    "a time in volts": (about(("unit: s", "unit: V")), [YAML, "'V' is no time"]),
    "a period of one sample": (
        about(("file: one.csv", "file: one.csv, period_samples: 1")),
        [YAML, "period_samples: 1", "2 or more"],
    ),
    "a period that is longer than half of the record": (
        about(("file: one.csv", "file: one.csv, period_samples: 100000000")),
        [YAML, "period_samples", "at most 300"],
    ),
    "a period that is none": (
        about(("file: one.csv", "file: one.csv, period_samples: 123")),
        [YAML, "one.csv", "differs from one period to the next"],
    ),
    "noise below nothing": (
        about(("records:", "noise_rms: -1\nrecords:")),
        [YAML, "noise_rms: -1", "above 0"],
    ),
    "noise that is not a number": (
        about(("records:", "noise_rms: .nan\nrecords:")),
        [YAML, "noise_rms: nan", "a finite number"],
    ),
    "a hold that is none": (
        about(("unit: A", "unit: A, hold: zoh")),
        [YAML, "input: hold: 'zoh' is unknown", "zero-order"],
    ),
    "an identification that is held out": (
        about(("records:", "identification: three\nrecords:")),
        [YAML, "'three' is held out"],
    ),
    "what is meant and is none": (
        about(("file: one.csv", "file: one.csv, meant: [copies]")),
        [YAML, "did you mean 'copy'?"],
    ),
}

BAD_MODELS = {
    "a list": (written("model.yaml", "- a\n"), ["model.yaml", "a mapping of keys"]),
    "nothing": (written("model.yaml", ""), ["model.yaml", "a mapping of keys"]),
    "a key twice": (
        model(("name: simulator", "name: a\nname: b")),
        ["model.yaml", "line 2", "'name'"],
    ),
    "a missing key": (model(("name: simulator\n", "")), ["missing key 'name'"]),
    "no blocks": (model(("chain:\n  - gain: {value: 12.0}", "chain: []")), [
        "model.yaml", "chain", "at least one block"]),
    "a chain that is a block": (model(("  - gain: {value: 12.0}", "  gain: 12")), [
        "model.yaml", "a list of blocks"]),
    "a misspelt block": (model(("gain", "gian")), [
        "model.yaml", "block 1", "unknown block 'gian'; did you mean 'gain'?"]),
    "a misspelt block as a word": (model(("gain: {value: 12.0}", "gian")), [
        "model.yaml", "block 1", "did you mean 'gain'?"]),
    "parameters beside the block": (
        model(("gain: {value: 12.0}", "gain:\n    value: 12.0")),
        ["model.yaml", "block 1", "2 keys (gain, value)", "deeper than its name"],
    ),
    "a block that is a number": (model(("gain: {value: 12.0}", "12")), [
        "model.yaml", "block 1", "one block and its parameters"]),
    "a misspelt parameter": (model(("value", "valeu")), ["did you mean 'value'?"]),
    "a parameter that is a word": (model(("12.0", "much")), [
        "block 1 (gain)", "value: expected a number, got 'much'"]),
    "a parameter that is not a number": (model(("12.0", ".nan")), ["a finite number"]),
    "a parameter out of bounds": (
        model(("gain: {value: 12.0}", "drive-lag: {time_constant_s: -1}")),
        ["block 1 (drive-lag)", "time_constant_s: -1 is out of bounds"],
    ),
    "a unit that is none": (model(("unit: A", "unit: Amps")), [
        "model.yaml", "input: unit: 'Amps'", "did you mean 'amp'?"]),
    "another unit": (model(("unit: um", "unit: mm")), [
        "model.yaml", "'mm'", "'um'", "multiply"]),
    "a free parameter that is none": (
        model(("chain:", "free: [gain.valeu]\nchain:")),
        ["model.yaml", "free", "did you mean 'gain.value'?"],
    ),
    "a wrapper that has nothing to wrap": (
        model(("gain: {value", "hysteresis-shape: {thresholds: [1], weights: [1]} #")),
        ["model.yaml", "block 1", "expected hysteresis just before it"],
    ),
}  # fmt: skip

BAD_WORDS = {
    "no command": (("gaap",), ["no command 'gaap'", "did you mean 'gap'?"]),
    "no option": (
        (*GAP, "--limit-hihg", "3"),
        ["gap", "'--limit-hihg'", "--limit-high"],
    ),
    "no data": (("gap",), ["gap", "Missing argument 'DATASET'"]),
    "no model": (("gap", "data", "--out", "out"), ["Missing option '--model'"]),
    "a limit that is a word": ((*GAP, "--limit-low", "low"), ["--limit-low", "'low'"]),
    "limits the wrong way round": (
        (*GAP, "--limit-low", "1", "--limit-high", "-1"),
        ["--limit-low 1", "--limit-high -1", "lower one first"],
    ),
    "a limit that is not a number": ((*GAP, "--limit-rate", "nan"), ["rate", "nan"]),
    "a limit that is infinite": ((*GAP, "--limit-high", "inf"), ["high", "inf"]),
    "a rate below nothing": ((*GAP, "--limit-rate", "-5"), ["rate", "-5"]),
    "no such dataset": (("gap", "date", *GAP[2:]), ["date", "no such file"]),
    "a record for a dataset": (
        ("gap", "data/one.csv", *GAP[2:]),
        [
            "data/one.csv",
            "expected a dataset.yaml",
            "did you mean 'data/dataset.yaml'?",
        ],
    ),
    "a folder without a dataset": (("gap", ".", *GAP[2:]), ["dataset.yaml"]),
    "no such model": (base("modle.yaml"), ["modle.yaml", "did you mean 'model.yaml'?"]),
    "a folder for a model": (base("data"), ["'data' is a folder", "a model file"]),
    "a record for a model": (base("data/one.csv"), ["one.csv", "a mapping of keys"]),
    "a dataset for a model": (base("data/dataset.yaml"), ["unknown key 'time'"]),
    "a misspelt word": (base("liner"), ["did you mean 'linear'?"]),
    "a column that is not there": (base("column"), ["no simulated output"]),
    "a file of Python": (base("bad_fn.py"), ["package.module:function", "'bad_fn:"]),
    "a function of a file": (base("bad_fn.py:nan"), ["here 'bad_fn:nan'"]),
    "a module that is not there": (base("bad_fm:nan"), ["cannot import 'bad_fm'"]),
    "a function that is not there": (base("bad_fn:nam"), ["did you mean 'nan'?"]),
    "a function that is a number": (base("bad_fn:number"), ["expected a function"]),
    "a function that raises": (
        base("bad_fn:raises"),
        ["raised KeyError", "600 samples"],
    ),
    "a function that leaves": (base("bad_fn:leaves"), ["raised SystemExit"]),
    "a function of one argument": (base("bad_fn:one"), ["raised TypeError"]),
    "a function that gives too few": (base("bad_fn:short"), ["shape (599,)", "(600,)"]),
    "a function that gives no numbers": (base("bad_fn:nan"), ["nan at sample 0"]),
    "a function that gives nothing": (base("bad_fn:nothing"), ["bad_fn:nothing"]),
    "a function of complex numbers": (base("bad_fn:complex"), ["complex"]),
    "a function that throws dice": (base("bad_fn:random"), ["the same one every time"]),
    "no such record": (("load", "data", "oen", *LOAD[3:]), ["did you mean 'one'?"]),
    "a record that is a model": (
        ("simulate", "model.yaml", "model.yaml", "--out", "out"),
        ["model.yaml", "no column 'time_s'"],
    ),
    "a hold that is none": ((*SIMULATE, "--hold", "zoh"), ["--hold", "zero-order"]),
    "a model in the place of a record": (
        ("simulate", "data/one.csv", "model.yaml", "--out", "out"),
        ["one.csv", "a mapping of keys"],
    ),
    "an archive that is none": (
        ("simulate", "model.yaml", "no.npz", "--out", "out"),
        ["no.npz"],
    ),
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
