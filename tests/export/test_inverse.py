"""Inverses that run sample by sample: what the model makes of their output."""

import shutil
import types

import numpy as np
import pytest

from hystbench.blocks.step import Sampling
from hystbench.errors import InputError
from hystbench.export import python
from hystbench.export.inverse import describe_inverse
from tests.blocks.examples import EXAMPLES
from tests.conftest import run_hystbench

from .compiled import Compiled
from .test_steps import DT, INPUT, chain_of, model_of

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler here")

PLAIN = {key: EXAMPLES["prandtl-ishlinskii"][key] for key in ("thresholds",)}
PI = ("prandtl-ishlinskii", PLAIN | {"weights": [0.5, 0.3, 0.2]})
CUBES = ("prandtl-ishlinskii", EXAMPLES["prandtl-ishlinskii"])
GPI = ("gpi", EXAMPLES["gpi"])
GAIN = ("gain", {"value": -3.0, "offset": 0.4})
DRIVE = ("drive-lag", {"time_constant_s": 1e-3, "hold": "band-limited"})
SENSOR = ("sensor-lag", {"time_constant_s": 5e-4, "hold": "band-limited"})
CREEP = ("creep", EXAMPLES["creep"] | {"hold": "band-limited"})
LIMITS = (-0.7, 0.7)

EXACT = {
    "gain": (GAIN,),
    "plays": (PI,),
    "generalized plays": (GPI,),
    "plays and powers": (CUBES,),
    "gain before and behind": (("gain", {"value": 1.1}), GPI, GAIN),
    "two hystereses": (PI, ("gain", {"value": 0.1}), GPI),
}
LAGS = {
    "a lag": (DRIVE,),
    "a lag behind plays": (GPI, SENSOR),
    "a lag on both sides": (DRIVE, PI, SENSOR),
    "creep": (GPI, CREEP),
}


def inverted(blocks, delay=0, limits=LIMITS):
    model = model_of("rig", chain_of(*blocks))
    return model, describe_inverse(model, Sampling(DT, delay=delay), limits)


@pytest.mark.parametrize("name", EXACT)
def test_plays_and_gains_are_undone_to_rounding(name, tmp_path):
    model, inverse = inverted(EXACT[name])
    wanted = model.simulate(INPUT, DT)
    u = Compiled([inverse], tmp_path).outputs(wanted)["rig_inverse"]
    off = np.abs(model.simulate(u, DT) - wanted).max() / np.ptp(wanted)
    assert off < 1e-12


@pytest.mark.parametrize("delay", [0, 2])
@pytest.mark.parametrize("name", LAGS)
def test_lags_are_undone_as_near_as_a_rate_is_known(name, delay, tmp_path):
    """Sines of 140 samples a period and more; the start is no part of the signal."""
    model, inverse = inverted(LAGS[name], delay)
    wanted = model.simulate(INPUT, DT)
    u = Compiled([inverse], tmp_path).outputs(wanted)["rig_inverse"]
    made = model.simulate(u[delay:], DT)
    off = np.abs(made - wanted[: len(made)])[300:-20]
    assert np.sqrt(np.mean(off**2)) / np.ptp(wanted) < 2e-3
    assert inverse.differences


def test_what_is_out_of_reach_stands_at_the_limits(tmp_path):
    _, inverse = inverted((GPI,), limits=(-0.3, 0.2))
    u = Compiled([inverse], tmp_path).outputs(100 * INPUT)["rig_inverse"]
    assert u.min() == -0.3
    assert u.max() == 0.2
    assert np.isfinite(u).all()


@pytest.mark.parametrize("name", [*EXACT, *LAGS])
def test_python_is_the_c(name, tmp_path):
    model, inverse = inverted({**EXACT, **LAGS}[name])
    wanted = model.simulate(INPUT, DT)[:300]
    space = types.ModuleType("exported").__dict__
    exec(python.module(inverse), space)  # noqa: S102
    c = Compiled([inverse], tmp_path).outputs(wanted)["rig_inverse"]
    np.testing.assert_allclose(space["Model"]().simulate(wanted), c, atol=1e-9)


@pytest.mark.parametrize(
    ("block", "why"),
    [
        (("resonance", EXAMPLES["resonance"] | {"participation": 1.0}), "derivative"),
        (("saturation", EXAMPLES["saturation"]), "none is known"),
        (("gain", {"value": 0.0}), "its value is 0"),
        (
            # A zero in the right half plane: the reciprocal runs away.
            ("transfer-function", {"numerator": [-1, 100], "denominator": [1, 100]}),
            "its inverse is unstable",
        ),
    ],
)
def test_what_cannot_be_undone_is_one_line(block, why):
    with pytest.raises(InputError, match=r"^chain: block 2: ") as told:
        inverted((GPI, block))
    assert why in str(told.value)
    assert "hystbench invert --reference" in str(told.value)


def test_the_command_writes_it_with_its_limits(tmp_path):
    file = tmp_path / "rig.yaml"
    model_of("rig", chain_of(GPI, GAIN)).save(file)
    asked = [
        "export",
        file,
        "--inverse",
        "--to",
        "c",
        "--dt",
        DT,
        "--out",
        tmp_path / "c",
    ]
    done = run_hystbench(*asked)
    assert done.returncode == 2
    assert "--limit-low: expected it beside --inverse" in done.stderr
    done = run_hystbench(*asked, "--limit-low", 0, "--limit-high", 0.7)
    assert done.returncode == 0, done.stderr
    header = (tmp_path / "c" / "rig_inverse.h").read_text()
    assert "current (A) of displacement (um)" in " ".join(header.split())
    done = run_hystbench(*asked, "--limit-low", 1, "--limit-high", 0.7)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
