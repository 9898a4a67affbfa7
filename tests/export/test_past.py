"""Starts that stand for what came before a record: with it, code is its simulation."""

import shutil
import subprocess
import sys

import numpy as np
import pytest

from hystbench.blocks.step import Sampling
from hystbench.errors import InputError
from hystbench.export.code import loaded
from hystbench.export.described import describe
from hystbench.export.inverse import describe_inverse
from hystbench.export.on_record import begun, begun_inverse
from tests.blocks.examples import EXAMPLES
from tests.conftest import run_hystbench

from .compiled import Compiled
from .test_steps import COUNT, DT, INPUT, TIME, chain_of, model_of

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler here")

#: A record that begins in the middle of a motion.
RECORD = np.roll(INPUT, -130) + 0.1
GPI = ("gpi", EXAMPLES["gpi"] | {"start": "settled"})
RATE = EXAMPLES["rate-dependent-hysteresis"] | {"hold": "linear"}


def moving(name, **more):
    return (name, EXAMPLES[name] | {"start": "moving", "hold": "linear"} | more)


CHAINS = {
    "plays": (GPI,),
    "plays behind a lag": (("drive-lag", EXAMPLES["drive-lag"]), GPI),
    "plays that a field drives": (
        GPI,
        ("rate-dependent-hysteresis", RATE | {"form": "acting-field"}),
    ),
    "a motion": (moving("transfer-function"),),
    "a motion behind plays": (GPI, moving("transfer-function")),
    "a coordinate that moves": (moving("mechanism"),),
    "a motion that repeats": (moving("transfer-function", start="repeating"),),
    "a coordinate that repeats its way against forces": (
        moving("mechanism", start="repeating"),
        ("friction-force", EXAMPLES["friction-force"]),
        moving("other-modes", start="repeating"),
    ),
    "a coordinate that moves against forces": (
        moving("mechanism"),
        ("stiffness", EXAMPLES["stiffness"]),
        ("friction-force", EXAMPLES["friction-force"]),
    ),
}


@pytest.mark.parametrize("name", CHAINS)
def test_code_starts_as_the_simulation_of_the_record(name, tmp_path):
    model = model_of("begun", chain_of(*CHAINS[name]))
    plain = describe(model, Sampling(DT))
    assert any("without --past" in told for told in plain.differences)
    code = begun(plain, model, RECORD)
    assert not code.differences
    wanted = model.simulate(RECORD, DT)
    y = Compiled([code], tmp_path).outputs(RECORD)["begun"]
    assert np.abs(y - wanted).max() <= 1e-9 * np.ptp(wanted)
    few = loaded(code).simulate(RECORD[:200])
    assert np.abs(few - wanted[:200]).max() <= 1e-9 * np.ptp(wanted)
    # Without the record it is another start, or the record would be worth nothing.
    without = Compiled([plain], tmp_path).outputs(RECORD)["begun"]
    assert np.abs(without - wanted).max() > 1e-4 * np.ptp(wanted)


SMOOTH = {"hold": "band-limited"}
LATE = {
    "plays that a field drives": (
        GPI,
        ("rate-dependent-hysteresis", RATE | SMOOTH | {"form": "acting-field"}),
    ),
    "a motion": (moving("transfer-function", **SMOOTH),),
    "modes that move": (
        moving("mechanism", **SMOOTH),
        ("friction-force", EXAMPLES["friction-force"]),
        moving("other-modes", **SMOOTH),
    ),
}


@pytest.mark.parametrize("name", LATE)
@pytest.mark.parametrize("delay", [1, 15])
def test_late_code_starts_as_the_simulation_of_the_record_too(name, delay, tmp_path):
    model = model_of("begun", chain_of(*LATE[name]))
    code = begun(describe(model, Sampling(DT, delay=delay)), model, RECORD)
    y = Compiled([code], tmp_path).outputs(RECORD)["begun"]
    wanted = model.simulate(RECORD, DT)[:-delay]
    np.testing.assert_array_equal(y[:delay], 0.0)
    # It is smooth up to where it was rolled.
    off = np.abs(y[delay:] - wanted)[:800]
    assert off.max() <= 1e-5 * np.ptp(wanted)


def test_an_inverse_begins_with_the_plays_that_the_record_leaves(tmp_path):
    model = model_of("begun", chain_of(GPI))
    limits = (2 * RECORD.min(), 2 * RECORD.max())
    code = begun_inverse(describe_inverse(model, Sampling(DT), limits), model, RECORD)
    u = Compiled([code], tmp_path).outputs(model.simulate(RECORD, DT))["begun_inverse"]
    made = model.simulate(u, DT)
    assert np.abs(made - model.simulate(RECORD, DT)).max() < 1e-9 * np.ptp(made)
    moves = {"numerator": [0.5, 100.0], "denominator": [1.0, 100.0], "start": "moving"}
    plain = model_of("moves", chain_of(("transfer-function", moves)))
    with pytest.raises(InputError, match="--past: expected none"):
        begun_inverse(describe_inverse(plain, Sampling(DT), limits), plain, RECORD)


def test_a_machine_that_is_reset_begins_so_again():
    model = model_of("begun", chain_of(GPI))
    code = loaded(begun(describe(model, Sampling(DT)), model, RECORD))
    first = code.simulate(RECORD[:50])
    code.reset()
    np.testing.assert_array_equal(code.simulate(RECORD[:50]), first)


def test_a_record_is_refused_where_it_says_nothing():
    model = model_of("at rest", chain_of(("gpi", EXAMPLES["gpi"])))
    with pytest.raises(InputError, match=r"^--past: expected none, as no block"):
        begun(describe(model, Sampling(DT)), model, RECORD)


def test_the_command_takes_a_record_of_the_same_interval(tmp_path):
    model = tmp_path / "model.yaml"
    model_of("begun", chain_of(GPI)).save(model)
    record = tmp_path / "record.csv"
    rows = np.column_stack([TIME, RECORD])
    np.savetxt(record, rows, "%.12g", ",", header="time_s,current_A", comments="")
    asked = ("export", model, "--to", "python", "--past", record)
    done = run_hystbench(*asked, "--dt", 1e-3, "--out", tmp_path / "no")
    assert done.returncode == 2
    assert done.stderr == (
        f"hystbench: {record}: sampled every 0.0001 s; expected --dt, 0.001 s\n"
    )
    done = run_hystbench(*asked, "--dt", DT, "--out", tmp_path / "yes")
    assert done.returncode == 0, done.stderr
    code = (sys.executable, "-c", "import begun, numpy; u = numpy.load('u.npy');"
        " numpy.save('y.npy', begun.Model().simulate(u))")  # fmt: skip
    np.save(tmp_path / "yes" / "u.npy", RECORD)
    subprocess.run(code, cwd=tmp_path / "yes", check=True)
    wanted = model_of("begun", chain_of(GPI)).simulate(RECORD, DT)
    assert len(wanted) == COUNT
    y = np.load(tmp_path / "yes" / "y.npy")
    assert np.abs(y - wanted).max() <= 1e-9 * np.ptp(wanted)
