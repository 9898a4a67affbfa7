"""A dead zone with rounded corners, as of an amplifier without feedback."""

import numpy as np
import pytest

from hystbench.blocks.transfer_function import TransferFunction
from hystbench.model import Model
from hystbench.record import Channel
from tests.gap.made import bent_first
from tests.gap.searched import among, search

DRIVE, OUTPUT = Channel("drive", "V"), Channel("output", "V")
POLE = TransferFunction(numerator=(1.0,), denominator=(4e-3, 1.0), hold="linear")
BASE = Model("pole", DRIVE, OUTPUT, (POLE,))
CURVES = among(
    *("dead-zone", "asymmetry", "saturation", "drive-saturation", "backlash"),
    *("sensor-nonlinearity", "hysteresis"),
)


def records(bend):
    return bent_first(POLE, bend, (0.4, 1.5), 41, 0.004, (DRIVE, OUTPUT))


# Where both are alike nothing passes at rest: at the end of what the block accepts.
@pytest.mark.parametrize("rounding", [0.18, 0.2])
def test_a_crossover_is_a_dead_zone_with_its_width_and_rounding(rounding):
    given = records(lambda u: u - 0.18 * np.tanh(u / rounding))
    answer = search("amplifier", given, BASE, "linear", vocabulary=CURVES)
    (effect,) = answer.content["effects"]
    assert effect["name"] == "dead-zone"
    told = {name: item["value"] for name, item in effect["parameters"].items()}
    assert told["half_width"] == pytest.approx(0.18, rel=0.02)
    assert told["rounding"] == pytest.approx(rounding, rel=0.05)


def test_corners_are_not_rounded():
    given = records(lambda u: np.sign(u) * np.maximum(np.abs(u) - 0.2, 0.0))
    answer = search("amplifier", given, BASE, "linear", vocabulary=CURVES)
    (effect,) = answer.content["effects"]
    assert effect["name"] == "dead-zone"
    assert effect["parameters"]["half_width"]["value"] == pytest.approx(0.2, rel=0.02)
    assert list(effect["parameters"]) == ["half_width"]
