"""How far code is from the simulation of a user's record: what is known beforehand."""

import numpy as np
import pytest

from hystbench.blocks.step import Sampling
from hystbench.errors import InputError
from hystbench.export.described import describe
from hystbench.export.on_record import off
from hystbench.record import Channel, Record
from tests.conftest import run_hystbench

from .test_steps import DT, INPUT, chain_of, model_of

GAIN = ("gain", {"value": 2.0})
SMOOTH = ("drive-lag", {"time_constant_s": 1e-3, "hold": "band-limited"})


def record_of(model, u):
    y = model.simulate(u, DT)
    ends = Channel("current", "A"), Channel("displacement", "um")
    return Record("held", DT, u, y, *ends, "measured", "hold-out")


def written(path, u):
    rows = np.column_stack([np.arange(len(u)) * DT, u])
    np.savetxt(path, rows, "%.17g", ",", header="time_s,current_A", comments="")
    return path


def test_code_of_another_gain_is_as_far_off_as_the_gains_are():
    """The code doubles, the simulation takes half of that: off by half its range."""
    doubled, plain = (model_of("g", chain_of((n, v))) for n, v in (
        GAIN, ("gain", {"value": 1.0}),
    ))  # fmt: skip
    u = np.concatenate([np.zeros(10), np.linspace(0.0, 1.0, 21)])
    found = off(describe(doubled, Sampling(DT)), plain, u)
    assert found.largest == pytest.approx(1.0)
    assert found.time_s == pytest.approx(30 * DT)
    assert found.rms == pytest.approx(np.sqrt(np.mean(u**2)))


def test_late_code_is_held_against_the_simulation_so_many_samples_before():
    model = model_of("lag", chain_of(SMOOTH))
    late = off(describe(model, Sampling(DT, delay=4)), model, INPUT)
    assert late.rms < off(describe(model, Sampling(DT)), model, INPUT).rms < 1e-6


@pytest.mark.parametrize(
    ("u", "words"), [(np.ones(50), "range 0"), (np.arange(3.0), "3 samples")]
)
def test_a_record_that_says_nothing_is_refused(u, words):
    model = model_of("lag", chain_of(SMOOTH))
    with pytest.raises(InputError, match=words):
        off(describe(model, Sampling(DT, delay=4)), model, 0 * u if u.all() else u)


def test_the_command_says_how_far_its_code_is(tmp_path):
    file, record = tmp_path / "model.yaml", written(tmp_path / "u.csv", INPUT)
    model = model_of("lag", chain_of(SMOOTH))
    model.save(file)
    asked = ("export", file, "--to", "c", "--dt", DT, "--compare", record)
    done = run_hystbench(*asked, "--out", tmp_path / "c")
    assert done.returncode == 0, done.stderr
    found = off(describe(model, Sampling(DT)), model, INPUT)
    assert f"{record}: {found.words}." in done.stdout
    assert f"{found.largest:.2g} of the output's range" in done.stdout


@pytest.mark.parametrize(
    ("more", "u", "said"),
    [
        (("--inverse", "--limit-low", 0, "--limit-high", 1), INPUT, "with --inverse"),
        ((), 0 * INPUT, "range 0; expected a finite one above 0"),
    ],
)
def test_what_cannot_be_compared_is_one_line_and_nothing_is_written(
    tmp_path, more, u, said
):
    file, record = tmp_path / "model.yaml", written(tmp_path / "u.csv", u)
    model_of("lag", chain_of(SMOOTH)).save(file)
    asked = ("export", file, "--to", "c", "--dt", DT, "--compare", record, *more)
    done = run_hystbench(*asked, "--out", tmp_path / "c")
    assert done.returncode == 2
    assert done.stderr.startswith("hystbench: --compare: ")
    assert said in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "c").exists()
