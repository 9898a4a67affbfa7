"""Simulators of somebody's own, each a real one of another program."""

import shlex
import shutil
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from hystbench.blocks.calls import Calls, counted
from hystbench.blocks.command import Command
from hystbench.blocks.fmu import Fmu
from hystbench.blocks.kept_outputs import KeptOutputs
from hystbench.blocks.onnx import Onnx, _shaped
from tests.blocks.simulators import FILES, RNN, compiled, needs, unit
from tests.messages import message

DT = 1e-3
U = np.sin(2 * np.pi * 7 * DT * np.arange(400))
ZERO = np.zeros(400)


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    return compiled(tmp_path_factory.mktemp("program"))


@pytest.fixture(scope="module")
def lag(tmp_path_factory):
    return unit(tmp_path_factory.mktemp("unit"))


def tenth(u, gain=3.0):
    y, state = [], 0.0
    for value in u.tolist():
        state += 0.1 * (gain * value - state)
        y.append(state)
    return np.array(y)


def test_a_program_of_c(program):
    y = Command(command=str(program)).simulate(U, U, DT)
    np.testing.assert_allclose(y, tenth(U), rtol=1e-12)
    y = Command(command=f"{program} 5").simulate(U, U, DT)
    np.testing.assert_allclose(y, tenth(U, 5.0), rtol=1e-12)


def test_a_program_of_the_shell_by_files(tmp_path):
    if shutil.which("awk") is None:
        pytest.skip("no awk")
    script = tmp_path / "twice.sh"
    script.write_text(
        'echo "time,u,y" > "$2"\n'
        'awk -F, -v dt="$3" \'NR > 1 { printf "%s,%s,%.17g\\n", $1, $2, $2 * dt }\''
        ' "$1" >> "$2"\n'
    )
    block = Command(command=f"sh {script} {{input}} {{output}} {{dt}}")
    np.testing.assert_allclose(block.simulate(U, U, DT), U * DT, rtol=1e-12)


def test_a_program_of_octave(tmp_path):
    if shutil.which("octave-cli") is None:
        pytest.skip("GNU Octave is not installed")
    script = tmp_path / "model.m"
    script.write_text(
        "words = argv(); data = dlmread(words{end - 1}, ',', 1, 0);\n"
        "dlmwrite(words{end}, filter(0.1, [1, -0.9], 3 * data(:, 2)), "
        "'precision', '%.17g');\n"
    )
    block = Command(command=f"octave-cli --norc {script} {{input}} {{output}}")
    np.testing.assert_allclose(block.simulate(U, U, DT), tenth(U), rtol=1e-9)


def test_nothing_goes_through_a_shell(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    said = message(
        lambda: Command(command="cut -d, -f2; touch pwned").simulate(U, U, DT)
    )
    assert "cut" in said
    assert not (tmp_path / "pwned").exists()


PYTHON = sys.executable
BAD = {
    "no program": (
        "./absent --fast",
        ["cannot start './absent'", "not of the model file"],
    ),
    "a status": ("ls /absent/folder", ["ended with status", "absent"]),
    "too few rows": ("echo 1", ["wrote 1 rows", "'1'", "expected 400"]),
    "words": ("sed s/[0-9].*/word/", ["expected y", "'word'"]),
    "no file": ("true {input} {output}", ["it wrote no file"]),
    "no cells": (
        f"{PYTHON} -c 'print(\",\\n\" * 400)'",
        ["it wrote ',' as row 1", "expected y"],
    ),
    "no y": (f"{PYTHON} -c 'print(\"0.1,\\n\" * 400)'", ["'0.1,' as row 1"]),
    "no numbers": (f"{PYTHON} -c 'print(\"nan\\n\" * 400)'", ["nan at sample 0"]),
}


@pytest.mark.parametrize(("command", "words"), BAD.values(), ids=BAD)
def test_a_bad_program_is_one_line(command, words):
    said = message(lambda: Command(command=command).simulate(U, U, DT))
    for word in words:
        assert word in said


def said_of(*rows, dt=DT):
    code = f"print({chr(10).join(rows)!r})"
    count = len(rows) - rows[0].startswith("t")
    u = np.zeros(count)
    return Command(command=shlex.join([PYTHON, "-c", code])).simulate(u, u, dt)


@pytest.mark.parametrize(
    "rows",
    [
        ["0,397", "0,421"],
        ["time", "0,397", "1"],
        ["0;0,397", "0,001;0,421"],
        ["0.0;0,397", "0.001;0,421"],
        ["t;y", "0\t0,397", "0\t0,421"],
        ["t,y", "0,0,0,397", "0,001,0,421"],
        ["1,5e-3", "1,5e-3"],
    ],
)
def test_a_decimal_comma_is_refused_in_one_line(rows):
    said = message(lambda: said_of(*rows))
    assert "as row 1, whose comma may be a decimal one" in said
    assert "expected y with a decimal point, or a header such as time_s,u" in said
    assert "\n" not in said


@pytest.mark.parametrize(
    "rows",
    [
        ["0,3", "0.001,5"],
        ["0,3", "1e-3,5"],
        ["time,y", "0,3", "7,5"],
        ["t;y", "0,0;3", "0,001;5"],
        ["0, 3", "1, 5"],
        ["0 ,3", "1 ,5"],
        ["0\t3", "1\t5"],
        ["3", "5"],
    ],
)
def test_a_comma_that_parts_cells_is_known_as_one(rows):
    assert said_of(*rows).tolist() == [3, 5]


def test_a_program_that_never_ends_is_ended():
    block = Command(command="sleep 1000", timeout_s=0.05)
    said = message(lambda: block.simulate(U, U, DT))
    assert "ran for more than 0.05 s (timeout_s)" in said


def test_no_command_line_is_refused():
    assert "expected a command line" in message(lambda: Command(command="a 'b"))


def test_a_unit_for_co_simulation(lag):
    block = Fmu(file=str(lag))
    y = block.simulate(U, U, DT)
    # The input stands through a step, so the lag is exact: 2 ms, gain 3.
    expected, state = [0.0], 0.0
    for value in U[:-1]:
        state += (1 - np.exp(-DT / 0.002)) * (3 * value - state)
        expected.append(state)
    # Its thousand steps of Euler in each of ours are off by h / 2 tau.
    np.testing.assert_allclose(y, expected, atol=2e-3)
    np.testing.assert_array_equal(block.simulate(U, U, DT), y)
    named = Fmu(file=str(lag), input="current", output="stroke")
    np.testing.assert_array_equal(named.simulate(U, U, DT), y)


def test_a_bad_unit_is_one_line(lag, tmp_path):
    needs("fmpy")
    said = message(lambda: Fmu(file=str(lag), output="strok").simulate(U, U, DT))
    assert "did you mean 'stroke'?" in said
    said = message(lambda: Fmu(file="absent.fmu").simulate(U, U, DT))
    assert "no file 'absent.fmu'" in said
    (tmp_path / "bad.fmu").write_bytes(b"no archive")
    said = message(lambda: Fmu(file=str(tmp_path / "bad.fmu")).simulate(U, U, DT))
    assert "cannot be read (" in said


def test_a_recurrent_network():
    needs("onnxruntime")
    y = Onnx(file=str(RNN)).simulate(U, U, DT)
    h, expected = 0.0, []
    for value in U:
        h = np.tanh(0.5 * value + 0.8 * h)
        expected.append(3 * h)
    np.testing.assert_allclose(y, expected, atol=1e-5)  # of 32 bits


def test_a_graph_of_64_bits():
    needs("onnxruntime")
    y = Onnx(file=str(FILES / "polynomial.onnx")).simulate(U, U, DT)
    np.testing.assert_allclose(y, 2 * U + 0.25 * U**2, rtol=1e-14, atol=1e-16)


@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        (["batch", 400, 1], (1, 400, 1)),
        ([None, 400], (1, 400)),
        (["batch", "time", 1], (1, 400, 1)),
        ([1, 400], (1, 400)),
    ],
)
def test_the_axis_of_time(shape, expected):
    item = SimpleNamespace(name="u", shape=shape, type="tensor(double)")
    found = _shaped("label", item, np.arange(400.0))
    assert found.shape == expected


def test_a_bad_graph_is_one_line(tmp_path):
    needs("onnxruntime")
    bad = tmp_path / "bad.onnx"
    bad.write_bytes(b"no graph")
    assert "cannot be read (" in message(lambda: Onnx(file=str(bad)).simulate(U, U, DT))
    import onnxruntime

    theirs = Path(onnxruntime.__file__).parent / "datasets" / "mul_1.onnx"
    if theirs.is_file():  # three rows of two: no sequence
        said = message(lambda: Onnx(file=str(theirs)).simulate(U, U, DT))
        assert "the shape [3, 2]" in said
        assert "one free axis for time (here 400 samples)" in said


def test_calls_are_counted_bounded_and_kept(program, tmp_path):
    block = Command(command=str(program))

    def run(**more):
        calls = Calls(**more, worth=0.0)
        with counted(calls):
            for u in (U, 2 * U, 2 * U):
                block.simulate(u, u, DT)
        return calls.made, calls.found

    def kept():
        return KeptOutputs(tmp_path / "cache", lambda line: None)

    assert run(kept=kept()) == (2, 0)  # the third is in memory
    # The first input is called in any case, the second comes from the disk.
    assert run(kept=kept()) == (1, 1)
    assert "are used up: 1" in message(lambda: run(bound=1))


def test_another_program_is_known_as_another(tmp_path):
    first = compiled(tmp_path)
    block = Command(command=str(first))
    before = block.source()
    first.write_bytes(first.read_bytes() + b"\0")
    assert block.source() != before
