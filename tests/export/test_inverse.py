"""Inverses that run sample by sample: what the model makes of their output."""

import shutil

import numpy as np
import pytest

from hystbench.blocks.step import Sampling
from hystbench.errors import InputError
from hystbench.export.code import loaded
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
MODE = (
    "resonance",
    {"frequency_hz": 800.0, "damping_ratio": 0.05, "participation": 1.0,
     "hold": "band-limited"},
)  # fmt: skip
MECHANISM = (
    "mechanism",
    EXAMPLES["mechanism"] | {"hold": "band-limited", "gain": 2.0, "bias": 0.1},
)
LIMITS = (-0.7, 0.7)


def rate(form, hold):
    values = EXAMPLES["rate-dependent-hysteresis"]
    return ("rate-dependent-hysteresis", values | {"form": form, "hold": hold})


EXACT = {
    "gain": (GAIN,),
    "plays": (PI,),
    "generalized plays": (GPI,),
    "plays and powers": (CUBES,),
    "gain before and behind": (("gain", {"value": 1.1}), GPI, GAIN),
    "two hystereses": (PI, ("gain", {"value": 0.1}), GPI),
    "a field that lags": (PI, rate("acting-field", "linear")),
    "relays": (("preisach", EXAMPLES["preisach"] | {"cells": 12}),),
    "a loop that yields": (("bouc-wen", EXAMPLES["bouc-wen"]),),
    "domains": (("jiles-atherton", EXAMPLES["jiles-atherton"]),),
    "plays whose output falls": (
        ("prandtl-ishlinskii", PLAIN | {"weights": [-1.5, -0.3, -0.2]}),
    ),
    "plays with another shape": (
        GPI,
        ("hysteresis-shape", EXAMPLES["hysteresis-shape"]),
    ),
    "relays that a field drives": (
        ("preisach", EXAMPLES["preisach"] | {"cells": 12}),
        rate("acting-field", "linear"),
    ),
    "noise and an offset": (
        PI,
        ("calibration-error", {"gain": 1.2, "offset": 0.1}),
        ("sensor-noise", {"rms": 0.1}),
    ),
}
CURVES = {
    "saturation": (("saturation", EXAMPLES["saturation"]),),
    "a curve that falls": (GAIN, ("saturation", {"level": 9.0, "sharpness": 2.0})),
    "asymmetry": (("asymmetry", EXAMPLES["asymmetry"]),),
    "a drive that stands": (("drive-saturation", {"limit": 0.65}), PI),
}
#: With how much of the range is left, RMS: sines of 140 samples a period and more.
LAGS = {
    "a lag": (DRIVE,),
    "a lag behind plays": (GPI, SENSOR),
    "a lag on both sides": (DRIVE, PI, SENSOR),
    "creep": (GPI, CREEP),
    "a mode": (MODE,),
    "a mode behind plays": (PI, MODE),
    "diffusion": (
        ("eddy-diffusion", {"time_constant_s": 4e-4, "hold": "band-limited"}),
    ),
    "two poles and a zero": (
        ("transfer-function",
         {"numerator": [1e-4, 1], "denominator": [1e-7, 1e-3, 1], "start": "settled",
          "hold": "band-limited"}),
    ),
    "a smooth field that lags": (PI, rate("acting-field", "band-limited")),
    "a coordinate": (MECHANISM,),
    "a coordinate with forces": (
        PI,
        MECHANISM,
        ("stiffness", EXAMPLES["stiffness"]),
        ("friction-force", EXAMPLES["friction-force"]),
    ),
    "a velocity": (("mechanism", {**MECHANISM[1], "output": "velocity"}),),
}  # fmt: skip


def inverted(blocks, delay=0, limits=LIMITS, name="rig"):
    model = model_of(name, chain_of(*blocks))
    return model, describe_inverse(model, Sampling(DT, delay=delay), limits)


@pytest.fixture(scope="module")
def undo(tmp_path_factory):
    """Give a model, its inverse, and what one program makes that runs all inverses."""
    known = {
        (name, 0): inverted(blocks, name=name)
        for name, blocks in {**EXACT, **CURVES, **LAGS}.items()
    }
    for name in LAGS:
        known[name, 2] = inverted(LAGS[name], 2, name=f"{name} late")
    inverses = [inverse for _, inverse in known.values()]
    run = Compiled(inverses, tmp_path_factory.mktemp("c"))

    def undone(name, delay=0):
        model, inverse = known[name, delay]
        return model, inverse, lambda wanted: run.outputs(wanted)[inverse.name]

    return undone


@pytest.mark.parametrize("name", EXACT)
def test_plays_and_gains_are_undone_to_rounding(name, undo):
    model, _, run = undo(name)
    wanted = model.simulate(INPUT, DT)
    u = run(wanted)
    off = np.abs(model.simulate(u, DT) - wanted).max() / np.ptp(wanted)
    assert off < 1e-12


@pytest.mark.parametrize("name", CURVES)
def test_curves_are_undone_as_near_as_their_table_says(name, undo):
    model, inverse, run = undo(name)
    wanted = model.simulate(INPUT, DT)
    u = run(wanted)
    off = np.abs(model.simulate(u, DT) - wanted).max() / np.ptp(wanted)
    assert off < 1e-6
    assert any("table" in told for told in inverse.differences)


def test_thresholds_that_grow_are_undone_with_a_rate_that_is_one_sample_old(tmp_path):
    """The rate of a sine of n samples a period changes by 2 pi / n in a sample."""
    model, inverse = inverted((PI, rate("growing-thresholds", "linear")))
    wanted = model.simulate(INPUT, DT)
    u = Compiled([inverse], tmp_path).outputs(wanted)["rig_inverse"]
    off = np.abs(model.simulate(u, DT) - wanted)[300:] / np.ptp(wanted)
    assert np.sqrt(np.mean(off**2)) < 2 * np.pi * 70 * DT / 10
    assert any("one sample old" in told for told in inverse.differences)


def test_a_delay_is_left_and_told(tmp_path):
    delay = ("input-delay", {"delay_s": 4 * DT})
    model, inverse = inverted((PI, delay))
    assert any("reference is 0.0004 s late" in told for told in inverse.differences)
    wanted = model.simulate(INPUT, DT)
    u = Compiled([inverse], tmp_path).outputs(wanted)["rig_inverse"]
    made = model.simulate(u, DT)
    assert np.abs(made[4:] - wanted[:-4]).max() < 1e-9 * np.ptp(wanted)


@pytest.mark.parametrize("name", LAGS)
@pytest.mark.parametrize("delay", [0, 2])
def test_dynamics_are_undone_as_near_as_rates_are_known(name, delay, undo):
    """Sines of 140 samples a period and more; the start is no part of the signal."""
    model, inverse, run = undo(name, delay)
    wanted = model.simulate(INPUT, DT)
    u = run(wanted)
    made = model.simulate(u[delay:], DT)
    off = np.abs(made - wanted[: len(made)])[300:-20]
    assert np.sqrt(np.mean(off**2)) / np.ptp(wanted) < 1e-3
    assert inverse.differences


def test_what_is_out_of_reach_stands_at_the_limits(tmp_path):
    _, inverse = inverted((GPI,), limits=(-0.3, 0.2))
    u = Compiled([inverse], tmp_path).outputs(100 * INPUT)["rig_inverse"]
    assert u.min() == -0.3
    assert u.max() == 0.2
    assert np.isfinite(u).all()


#: One of each sort: the module has the states and the arrays of what it calls.
@pytest.mark.parametrize(
    "name",
    ["gain", "relays that a field drives", "saturation", "a coordinate with forces"],
)
def test_python_is_the_c(name, undo):
    model, inverse, run = undo(name)
    wanted = model.simulate(INPUT, DT)[:300]
    made = loaded(inverse).simulate(wanted)
    np.testing.assert_allclose(made, run(wanted), rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    ("block", "why"),
    [
        (("dead-zone", {"half_width": 0.1}), "rise or fall throughout"),
        (("friction", EXAMPLES["friction"]), "none is known"),
        (("rdgpi", EXAMPLES["rdgpi"]), "depends on the rate that is sought"),
        (("gain", {"value": 0.0}), "its output does not depend on its input"),
        (
            ("mechanism", EXAMPLES["mechanism"] | {"output": "force"}),
            "is not a motion alone",
        ),
        (
            # Seven poles, (s / 100 + 1)^7, and no zero: as many derivatives.
            (
                "transfer-function",
                {"numerator": [1.0], "denominator": list(np.poly([-100.0] * 7) / 1e14)},
            ),
            "it takes 7 derivatives, and --points 6 gives less",
        ),
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


@pytest.mark.parametrize(
    ("block", "why"),
    [
        (
            ("butterfly", {"coefficient": 5.0, "threshold": 0.1}),
            "rise or fall throughout",
        ),
        (rate("excess-field", "linear"), "which diverges"),
    ],
)
def test_what_hysteresis_cannot_be_undone_is_one_line(block, why):
    with pytest.raises(InputError, match=r"^chain: block 1: gpi: ") as told:
        inverted((GPI, block))
    assert why in str(told.value)


def test_the_command_writes_it_with_its_limits(tmp_path):
    file = tmp_path / "rig.yaml"
    model_of("rig", chain_of(GPI, GAIN)).save(file)
    asked = ("export", file, "--inverse", "--to", "c", "--dt", DT)
    asked += ("--out", tmp_path / "c")
    done = run_hystbench(*asked)
    assert done.returncode == 2
    assert "--limit-low: expected it beside --inverse" in done.stderr
    done = run_hystbench(*asked, "--limit-low", 0, "--limit-high", 0.7)
    assert done.returncode == 0, done.stderr
    header = (tmp_path / "c" / "rig_inverse.h").read_text()
    assert "current (A) of displacement (um)" in " ".join(header.split())
    done = run_hystbench(*asked, "--limit-low", 1, "--limit-high", 0.7)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)


@pytest.mark.parametrize("name", ["other-modes", "other-mechanism"])
def test_modes_beside_a_mechanism_cannot_be_undone(name):
    beside = (name, EXAMPLES[name])
    with pytest.raises(InputError, match=r"^chain: block 2: mechanism: no inverse"):
        inverted((GPI, MECHANISM, beside))
