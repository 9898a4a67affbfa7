"""Structures that are tried: what each makes, and what it reads."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.calibration.structures import (
    CREEP_TIMES_S,
    STRUCTURES,
    asked_structures,
    find_structure,
    make_objective,
)
from hystbench.calibration.trial import starts
from hystbench.errors import InputError

from .trial_job import job

MIDDLE = {item.name: starts(item, 1, seed=1)[0] for item in STRUCTURES}


def model(name):
    return find_structure(name).make(MIDDLE[name])


def blocks(name):
    return [block.name for block in model(name).chain]


@pytest.mark.parametrize("name", [item.name for item in STRUCTURES])
def test_each_structure_makes_a_twin_of_what_is_free(name):
    assert "gpi" in blocks(name)
    assert set(MIDDLE[name]) == {x.name for x in find_structure(name).unknowns}


def test_diffusion_stands_where_the_lag_was():
    assert blocks("eddy-diffusion") == [
        "eddy-diffusion" if block == "transfer-function" else block
        for block in blocks("base")
    ]


def test_creep_is_mechanical_and_the_bias_comes_first():
    assert blocks("creep")[-3:] == ["creep", "calibration-error", "sensor-noise"]
    assert blocks("bias") == ["gain", *blocks("base")]


def test_the_cube_stands_beside_the_square():
    assert blocks("cube") == [
        "sensor-nonlinearity" if block == "asymmetry" else block
        for block in blocks("base")
    ]
    curve = model("cube").chain[1]
    z = np.array([-10.0, 10.0])
    np.testing.assert_allclose(
        curve.simulate(z, z, 1e-4), z + MIDDLE["cube"]["cube"] * z**3
    )


def test_the_roll_off_is_two_poles_of_unit_gain():
    added = model("roll-off").chain[-3]
    own = MIDDLE["roll-off"]
    gain = np.abs(added.frequency_response(np.array([0.0, own["roll-off"]])))
    np.testing.assert_allclose(gain, [1.0, 1 / (2 * own["roll-off damping"])])


def test_zero_errors_have_one_sign_each():
    for name, low, high in (("base", -0.03, 0.0), ("zero-positive", 0.0, 0.03)):
        own = {item.name: item for item in find_structure(name).unknowns}["input zero"]
        assert (own.low, own.high) == (low, high)
    assert "input zero" not in MIDDLE["zero-none"]


def test_what_is_tried_starts_where_it_matters():
    creep = [MIDDLE["creep"][f"creep {time} s"] for time in CREEP_TIMES_S]
    assert sum(creep) == pytest.approx(0.05)
    for name in ("bias", "cube"):
        signs = {np.sign(p[name]) for p in starts(find_structure(name), 2, seed=1)}
        assert signs == {-1, 1}


def test_noise_on_the_input_is_read_by_the_filters_alone():
    job_ = job()
    name = next(iter(job_["signals"]))
    with_noise = make_objective(find_structure("input-noise"), job_)
    values = MIDDLE["input-noise"] | {"input noise": 0.01}
    with_noise.cells(values, [name])
    noisy = with_noise._records[name]
    base = make_objective(find_structure("base"), job_)
    base.cells({k: v for k, v in values.items() if k != "input noise"}, [name])
    clean = base._records[name]
    np.testing.assert_array_equal(noisy.y, clean.y)
    noise = noisy.u - clean.u
    # The RMS of n normal draws is off by more than 4 / sqrt(2 n) in 1 of 16000.
    assert np.std(noise) == pytest.approx(0.01, rel=4 / np.sqrt(2 * len(noise)))


def test_envelopes_are_identified_on_the_twin_at_hand():
    found = make_objective(find_structure("identified-envelopes"), job())
    values = MIDDLE["identified-envelopes"]
    one, other = found.at(values), found.at(values | {"gain": values["gain"] / 2})
    # Half the displacement: about half the weights; the envelopes keep their scale.
    ratio = np.sum(one.identified["weights"]) / np.sum(other.identified["weights"])
    assert ratio == pytest.approx(2, rel=0.15)
    name = next(iter(found.signals))
    published = make_objective(find_structure("base"), job())
    assert published.at(values) is published
    ours, theirs = (each.cells(values, [name]).mse[name] for each in (one, published))
    assert ours["gpo"] != theirs["gpo"]
    assert ours["delayed"] == theirs["delayed"]


def test_readings_reach_the_records_and_the_filters():
    name = next(iter(job()["signals"]))
    long = make_objective(find_structure("record-1s"), job())
    assert len(long.signals[name].u) * long.signals[name].dt == pytest.approx(1.0)
    current = make_objective(find_structure("current-input"), job())
    assert current.filters["backlash"]["backlash_structure"] == "current-input"
    window = make_objective(find_structure("window"), job())
    whole = replace(window, window_start_s=0.0)
    values = MIDDLE["window"]
    assert window.cells(values, [name]).rms != whole.cells(values, [name]).rms


def test_an_unknown_structure_gets_the_nearest_name():
    with pytest.raises(InputError, match="creep"):
        find_structure("crep")
    with pytest.raises(InputError, match="creep"):
        asked_structures(["base", "crep"])
    assert asked_structures(None) == STRUCTURES
