"""``hystbench simulate``: a model on a record, units, holds and refusals."""

import csv
import json
import re
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from hystbench.model import load_model
from hystbench.record import Channel, Record
from hystbench.signals import Signal
from tests.conftest import csv_text, refused, run_hystbench

MODEL = """
name: small
input: {name: current, unit: A}
output: {name: displacement, unit: um}
chain:
  - gain: {value: 10}
  - drive-lag: {time_constant_s: 0.02}
"""
HEADER = "time_s,current_A,displacement_um"
TIME = np.arange(50) / 100
U = np.sin(2 * np.pi * 7 * TIME)


@pytest.fixture
def model(tmp_path):
    (tmp_path / "model.yaml").write_text(MODEL)
    return tmp_path / "model.yaml"


def table(path):
    with path.open(newline="") as stream:
        rows = list(csv.reader(stream))
    return rows[0], np.array(rows[1:], dtype=float).T


def about(extra="", unit="A"):
    return (
        "name: bench\ntime: {column: time_s, unit: s}\n"
        f"input: {{column: current_A, unit: {unit}{extra}}}\n"
        "output: {column: displacement_um, unit: um}\nrecords: [{file: a.csv}]\n"
    )


@pytest.mark.parametrize(
    ("extra", "option", "hold"),
    [
        ("", [], "band-limited"),
        (", hold: linear", [], "linear"),
        (", hold: linear", ["--hold", "zero-order"], "zero-order"),
    ],
)
def test_a_record_of_a_dataset(tmp_path, model, write_dataset, extra, option, hold):
    files = {"a.csv": csv_text(TIME + 3.0, U, 9 * U)}
    folder = write_dataset(files, about(extra)).parent
    out = tmp_path / "out.csv"
    arguments = ["simulate", model, folder / "a.csv", *option, "--out", out]
    result = run_hystbench(*arguments)
    assert result.returncode == 0, result.stderr
    assert f"hold where the model sets none: {hold}" in result.stdout
    header, columns = table(out)
    assert header == ["time_s", "current_A", "measured_um", "simulated_um"]
    held = load_model(model).with_hold(hold)
    expected = [TIME, U, 9 * U, held.simulate(U, 0.01)]
    np.testing.assert_allclose(columns, expected, rtol=0, atol=1e-7)
    # The same by a dataset.yaml that is named.
    (folder / "dataset.yaml").rename(folder / "other.yaml")
    again = run_hystbench(*arguments, "--dataset", folder / "other.yaml")
    assert again.returncode == 0, again.stderr


@pytest.mark.parametrize(
    ("periods", "start"), [("", "settled"), (", period_samples: 25", "repeating")]
)
def test_only_a_record_of_whole_periods_repeats(
    tmp_path, model, write_dataset, periods, start
):
    """What a model file calls repeating is settled on any other record."""
    lag = "time_constant_s: 0.02"
    model.write_text(MODEL.replace(lag, f"{lag}, start: repeating"))
    u = 1.0 + np.arange(50) % 25
    yaml = about().replace("file: a.csv", f"file: a.csv{periods}")
    folder = write_dataset({"a.csv": csv_text(TIME, u, u)}, yaml).parent
    out = tmp_path / "out.csv"
    result = run_hystbench("simulate", model, folder / "a.csv", "--out", out)
    assert result.returncode == 0, result.stderr
    *_, simulated = table(out)[1]
    begins = load_model(model)
    begins = replace(
        begins, chain=(begins.chain[0], replace(begins.chain[1], start=start))
    )
    wanted = begins.with_hold("band-limited").simulate(u, 0.01)
    np.testing.assert_allclose(simulated, wanted, rtol=1e-6)
    other = begins.with_hold("band-limited").begun_once().simulate(u, 0.01)
    assert np.allclose(simulated, other, rtol=1e-3) == (start == "settled")


def test_archives_of_records_and_signals(tmp_path, model):
    current, displacement = Channel("current", "A"), Channel("displacement", "um")
    Record("r", 0.01, U, 9 * U, current, displacement, "twin").save(tmp_path / "r.npz")
    Signal(name="s", dt=0.01, u=U, unit="A").save(tmp_path / "s.npz")
    expected = load_model(model).simulate(U, 0.01)
    for name, header in (
        ("r", ["time_s", "current_A", "measured_um", "simulated_um"]),
        ("s", ["time_s", "input_A", "simulated_um"]),
    ):
        out = tmp_path / f"{name}.csv"
        archive = tmp_path / f"{name}.npz"
        result = run_hystbench("simulate", model, archive, "--out", out)
        assert result.returncode == 0, result.stderr
        found, columns = table(out)
        assert found == header
        np.testing.assert_allclose(columns[-1], expected, rtol=1e-10)


@pytest.mark.parametrize(
    ("unit", "expected"),
    [
        (
            "mA",
            "write the model file in 'mA', its numbers too, or multiply the record's "
            "column by 0.001 and say 'A'",
        ),
        ("V", "expected the same unit"),
        ("furlong", "expected the same unit"),
    ],
)
def test_units_that_differ_are_refused(tmp_path, model, write_dataset, unit, expected):
    folder = write_dataset({"a.csv": csv_text(TIME, U, 9 * U)}, about(unit=unit)).parent
    out = tmp_path / "out.csv"
    said = refused("simulate", model, folder / "a.csv", "--out", out)
    assert f"input: unit 'A', but {folder / 'a.csv'} has {unit!r}" in said
    assert expected in said
    assert not out.exists()


@pytest.mark.parametrize(
    ("ours", "theirs"), [("A", "ampere"), ("A/cm**2", "A/cm2"), ("A/s", "A*s^-1")]
)
def test_one_unit_spelt_in_two_ways_is_one_unit(
    tmp_path, model, write_dataset, ours, theirs
):
    model.write_text(MODEL.replace("unit: A}", f"unit: {ours}}}"))
    folder = write_dataset(
        {"a.csv": csv_text(TIME, U, 9 * U)}, about(unit=theirs)
    ).parent
    out = tmp_path / "out.csv"
    result = run_hystbench("simulate", model, folder / "a.csv", "--out", out)
    assert result.returncode == 0, result.stderr


def test_what_cannot_be_run_is_one_line(tmp_path, model, write_dataset):
    files = {"a.csv": csv_text(TIME, U, 9 * U), "b.csv": csv_text(TIME, U, U)}
    folder = write_dataset(files, about()).parent
    (tmp_path / "no.npz").write_text("no archive")
    np.savez(tmp_path / "other.npz", unit="A", values=U)
    away = tmp_path / "away.yaml"
    away.write_text(
        MODEL + "  - stiffness-hardening: {coefficient: -1.0, "
        "frequency_hz: 10, damping_ratio: 0.1, participation: 1.0}\n"
    )
    for system, record, expected in (
        (model, folder / "b.csv", "is none of them; did you mean"),
        (model, tmp_path / "no.npz", "not an archive"),
        (model, tmp_path / "other.npz", "not a record of hystbench"),
        (away, folder / "a.csv", "the output is not finite from 0.0"),
    ):
        out = tmp_path / "out.csv"
        assert expected in refused("simulate", system, record, "--out", out)
        assert not out.exists()


OWN_INPUT = "time_s,current_A\n" + "".join(
    f"{t:.9g},{u:.9g}\n" for t, u in zip(TIME, U, strict=True)
)


def test_an_input_of_ones_own_needs_no_dataset(tmp_path, model):
    """Two columns are enough: time and the model's input, by its name and unit."""
    (tmp_path / "own.csv").write_text(OWN_INPUT)
    out = tmp_path / "out.csv"
    result = run_hystbench("simulate", model, tmp_path / "own.csv", "--out", out)
    assert result.returncode == 0, result.stderr
    header, columns = table(out)
    assert header == ["time_s", "current_A", "simulated_um"]
    expected = load_model(model).simulate(U, 0.01)
    np.testing.assert_allclose(columns[-1], expected, atol=1e-7)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (OWN_INPUT.replace("current_A", "curent_A"), "no column 'current_A'"),
        (OWN_INPUT.replace("current_A", "current_mA"), "no column 'current_A'"),
        (OWN_INPUT.replace("time_s", "time"), "no column 'time_s'"),
        (OWN_INPUT.replace("0.1,", "0.17,", 1), "increase"),
        # No dataset.yaml describes it: none of its keys is of any use.
        (OWN_INPUT.replace("0.05,", "0.054,", 1), "within 0.01 of a step\n"),
        (re.sub(r"\n0.05,.*", "\n0.05,NaN", OWN_INPUT), "expected a finite number\n"),
        ("", "no column"),
    ],
)
def test_an_input_that_does_not_fit_is_one_line(tmp_path, model, text, expected):
    (tmp_path / "own.csv").write_text(text)
    out = tmp_path / "out.csv"
    said = refused("simulate", model, tmp_path / "own.csv", "--out", out)
    assert expected in said
    assert not out.exists()


def test_a_model_file_is_used_from_python_in_two_lines(model):
    code = (
        "import sys, hystbench\n"
        "assert 'numpy' not in sys.modules, 'the package alone is light'\n"
        "from hystbench import load_model\n"
        f"print(load_model({str(model)!r}).simulate([0.0, 1.0, 1.0], 0.01).tolist())\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True)
    # A lag of 20 ms behind a gain of 10, its input a ramp and then constant.
    e = np.exp(-0.5)
    ramp = 10 * (1 - (1 - e) / 0.5)
    expected = [0.0, ramp, 10 - (10 - ramp) * e]
    np.testing.assert_allclose(json.loads(done.stdout), expected, rtol=1e-9)
