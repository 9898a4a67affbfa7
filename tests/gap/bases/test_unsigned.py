"""A sensor that shows a magnitude: the sign is put back, and the sensor is named."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases.linear import identified_linear
from hystbench.gap.bases.load import load_base
from hystbench.gap.bases.unsigned import with_signs
from hystbench.gap.records.evidence import Evidence
from hystbench.record import Channel, Record
from tests.gap.searched import among, search

DT, COUNT, NOISE = 0.02, 300, 0.02
VOLTAGE, SPEED = Channel("voltage", "V"), Channel("speed", "rad/s")

#: A motor behind a lag of half a second, and a pulley on a spring.
DRIVE = TransferFunction(
    numerator=(3.0 * 81.0,),
    denominator=tuple(np.polymul([0.5, 1.0], [1.0, 2.16, 81.0])),
    hold="zero-order",
)


def steps(levels, random):
    held = random.integers(15, 60, COUNT // 15)
    return np.repeat(random.choice(levels, len(held)), held)[:COUNT]


def evidence(shown, levels=(-1.0, -0.4, 0.3, 0.8, 1.2)):
    """Give records of a drive, and their true speeds."""
    random = np.random.default_rng(6)
    records, true = [], []
    for k in range(2):
        u = steps(levels, random)
        speed = DRIVE.simulate(u, u, DT)
        y = shown(speed) + NOISE * random.standard_normal(COUNT)
        records.append(Record(f"run-{k}", DT, u, y, VOLTAGE, SPEED, "measured", "fit"))
        true.append(speed)
    return Evidence("drive", tuple(records), (), "zero-order"), true


def test_the_sign_is_that_of_the_speed():
    found, true = evidence(np.abs)
    signed = with_signs(found)
    assert signed is not None
    for record, speed in zip(signed.fit, true, strict=True):
        clear = np.abs(speed) > 5 * NOISE
        assert np.mean(np.sign(record.y[clear]) == np.sign(speed[clear])) > 0.995
    for record, before in zip(signed.fit, found.fit, strict=True):
        np.testing.assert_array_equal(np.abs(record.y), np.abs(before.y))


@pytest.mark.parametrize(
    ("shown", "levels"),
    [(np.array, (-1.0, 1.0)), (np.abs, (0.2, 0.7, 1.0)), (lambda x: x + 9.0, (-1, 1))],
    ids=["a sign that is shown", "one way alone", "a large offset"],
)
def test_nothing_is_put_back_where_nothing_is_hidden(shown, levels):
    found, _ = evidence(shown, levels)
    assert with_signs(found) is None
    assert identified_linear(found).model.found_with == ""


def test_the_sensor_is_named_and_the_rest_is_noise():
    found, _ = evidence(np.abs)
    base, note = load_base("linear", found)
    assert "a sign that the sensor may not show" in note
    curves = among(
        *("sensor-nonlinearity", "asymmetry", "saturation", "dead-zone", "hysteresis"),
        *("drive-saturation", "calibration-error"),
    )
    answer = search("drive", found.fit, base, found.input_hold, vocabulary=curves)
    (effect,) = answer.content["effects"]
    assert effect["name"] == "sensor-nonlinearity"
    assert effect["blocks"] == ["unsigned-sensor"]
    left = [
        record.y - answer.model.simulate(record.u, record.dt) for record in found.fit
    ]
    assert np.sqrt(np.mean(np.square(left))) < 1.2 * NOISE


def test_records_of_one_sign_alone_are_as_they_were():
    found, _ = evidence(np.abs, (0.2, 0.7, 1.0))
    below = replace(found.fit[0], u=-found.fit[0].u)
    assert with_signs(replace(found, fit=(below,))) is None


@pytest.mark.parametrize("dt", [1e-9, 3600.0])
def test_records_of_any_rate_have_their_sign(dt):
    found, _ = evidence(np.abs)
    fit = tuple(replace(record, dt=dt) for record in found.fit)
    assert with_signs(replace(found, fit=fit)) is not None


def test_a_level_is_no_speed_without_a_sign():
    """Of a tank whose outflow goes with the root, a signed level does little better."""
    random = np.random.default_rng(3)
    records = []
    for k in range(2):
        u = steps((-0.5, 0.5, 1.0, 1.5), random)[: COUNT // 4]
        level = np.zeros(len(u))
        for i in range(len(u) - 1):
            flow = max(u[i], 0.0) - 0.5 * np.sqrt(level[i])
            level[i + 1] = max(level[i] + 0.1 * flow, 0.0)
        y = level + NOISE * random.standard_normal(len(u))
        records.append(Record(f"r{k}", DT, u, y, VOLTAGE, SPEED, "measured", "fit"))
    found = Evidence("tank", tuple(records), (), "zero-order")
    assert identified_linear(found).model.found_with == ""
