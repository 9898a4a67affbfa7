"""``hystbench job gap-check``: what can be known of all files before a search."""

import numpy as np
import pytest
import yaml

from hystbench.commands.jobs import gap_check as module
from hystbench.gap.bases import load as bases
from tests.gap.made import record, sine, write_folder
from tests.gap.tiny import write_tiny
from tests.messages import message

HELD_OUT = "unseen.csv"


@pytest.fixture
def tiny(tmp_path):
    return write_tiny(tmp_path)


def check(data, model):
    module.gap_check.callback(data, model=str(model))


def spoil(file, row, cells):
    """Write other cells in a row; the header is row 1."""
    lines = file.read_text().splitlines()
    lines[row - 1] = cells
    file.write_text("\n".join(lines) + "\n")


def rewrite(file, change):
    """Change input and output of a record."""
    time, u, y = np.loadtxt(file, delimiter=",", skiprows=1).T
    table = np.column_stack([time, *change(u, y)])
    header = file.read_text().partition("\n")[0]
    np.savetxt(file, table, "%.9g", ",", header=header, comments="")


def test_what_is_right_passes_and_nothing_is_written(tiny, tmp_path, capsys):
    data, base = tiny
    before = {item: item.stat().st_mtime_ns for item in tmp_path.rglob("*")}
    check(data, base)
    assert {item: item.stat().st_mtime_ns for item in tmp_path.rglob("*")} == before
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err == "tiny: 3 records to fit and 1 held out can be used\n"


@pytest.mark.parametrize("name", [HELD_OUT, "slow.csv"])
def test_a_cell_that_is_no_number_in_any_record(tiny, name):
    data, base = tiny
    spoil(data / name, 9, "0.0014,nan,1")
    said = message(lambda: check(data, base))
    assert f"{name}: row 9: column 'current_A' is 'nan'" in said


def test_a_clipped_hold_out_record(tiny):
    data, base = tiny
    rewrite(data / HELD_OUT, lambda u, y: (u, np.minimum(y, np.quantile(y, 0.6))))
    said = message(lambda: check(data, base))
    assert HELD_OUT in said
    assert "not clipped" in said


def test_units_of_a_model_file(tiny):
    data, base = tiny
    about = (data / "dataset.yaml").read_text()
    (data / "dataset.yaml").write_text(about.replace("unit: um", "unit: mm"))
    said = message(lambda: check(data, base))
    assert "base.yaml: output: unit 'um'" in said


def squares():
    chain = [{"gain": {"value": 1.0}}, *4 * [{"asymmetry": {"coefficient": 1e-6}}]]
    return {
        "name": "squares",
        "input": {"name": "current", "unit": "A"},
        "output": {"name": "displacement", "unit": "um"},
        "chain": chain,
    }


@pytest.mark.filterwarnings("ignore:overflow encountered:RuntimeWarning")
def test_a_model_file_that_is_not_finite_on_a_hold_out_input(tmp_path):
    """Each of four squares alone is far from the end of floating point."""
    u = sine(3.0, count=400)
    far = np.where(np.arange(400) < 250, u, 1e29 * u)
    made = [record(u, 5 * u, name="a"), record(far, u, name="b", use="hold-out")]
    data = write_folder(tmp_path / "d", made)
    model = tmp_path / "squares.yaml"
    model.write_text(yaml.safe_dump(squares()))
    said = message(lambda: check(data, model))
    assert said.startswith("squares: the output is not finite from 0.25 s of b on")


def test_a_function_that_is_not_finite_on_a_hold_out_input(tiny, tmp_path, monkeypatch):
    """It knows no small inputs; each fit record's goes to 0.8 A or more."""
    (tmp_path / "rig_of_check.py").write_text(
        "import numpy as np\n"
        "def run(u, dt):\n"
        "    return u if np.abs(u).max() > 0.7 else np.full(len(u), np.inf)\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    data, _ = tiny
    rewrite(data / HELD_OUT, lambda u, y: (u / 2, y))
    said = message(lambda: check(data, "rig_of_check:run"))
    assert "it gave inf at sample 0; expected finite numbers" in said


def test_a_function_that_gives_complex_numbers(tiny, tmp_path, monkeypatch):
    """No imaginary part is dropped unseen."""
    (tmp_path / "rig_of_waves.py").write_text(
        "def run(u, dt):\n    return u * (1 + 0.1j)\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    data, _ = tiny
    said = message(lambda: check(data, "rig_of_waves:run"))
    assert "it gave complex numbers; expected real ones" in said


@pytest.mark.parametrize("word", ["gpi", "linear"])
def test_a_base_that_is_to_be_identified_is_not_identified_here(
    tiny, monkeypatch, word
):
    def fail(*_):
        raise AssertionError(word)

    monkeypatch.setattr(bases, "identified_gpi", fail)
    monkeypatch.setattr(bases, "identified_linear", fail)
    check(tiny[0], word)
    spoil(tiny[0] / HELD_OUT, 9, "0.0014,nan,1")
    assert "row 9" in message(lambda: check(tiny[0], word))


@pytest.mark.parametrize(
    ("word", "expected"),
    [
        ("column", "has no simulated output"),
        ("base.yml", "base.yml"),
        ("liner", "did you mean 'linear'?"),
    ],
)
def test_a_base_that_is_none(tiny, word, expected):
    assert expected in message(lambda: check(tiny[0], word))
