"""What tells a limit of a drive from a material: a drive is straight below it."""

import numpy as np
import pytest

from hystbench.blocks.prandtl_ishlinskii import PrandtlIshlinskii
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.model import Model
from hystbench.record import Channel
from tests.gap.made import bent_first
from tests.gap.searched import among, search

DRIVE, OUTPUT = Channel("drive", "V"), Channel("output", "um")
STACK = PrandtlIshlinskii(thresholds=(0.1, 0.2, 0.4), weights=(0.3, 0.2, 0.1))


def named(bend):
    records = bent_first(STACK, bend, (0.3, 0.6), 61, 0.004, (DRIVE, OUTPUT))
    base = Model("stack", DRIVE, OUTPUT, (STACK,))
    answer = search("stack", records, base, "linear")
    return [effect["name"] for effect in answer.content["effects"]]


@pytest.mark.parametrize("sharpness", [8.0, 14.0])
def test_rounded_corners_are_a_limit_of_the_drive(sharpness):
    bent = named(lambda u: u / (1 + np.abs(u) ** sharpness) ** (1 / sharpness))
    assert bent == ["drive-saturation"]


@pytest.mark.parametrize(
    "bend", [np.tanh, lambda u: u / (1 + np.abs(u) ** 3) ** (1 / 3)]
)
def test_a_curve_that_bends_from_the_smallest_signals_on_is_the_material(bend):
    assert named(bend) == ["saturation"]


POLE = TransferFunction(numerator=(1.0,), denominator=(4e-3, 1.0), hold="linear")
CURVES = among(
    *("drive-saturation", "dead-zone", "asymmetry", "saturation", "hysteresis"),
    *("sensor-nonlinearity", "backlash"),
)


@pytest.mark.parametrize(
    ("bend", "name", "told"),
    [
        (lambda u: np.maximum(u, 0.0), "drive-saturation", {"lower": 0.0}),
        (lambda u: np.maximum(u, -0.3), "drive-saturation", {"lower": -0.3}),
        (lambda u: np.minimum(u, 0.4), "drive-saturation", {"upper": 0.4}),
        (
            lambda u: np.clip(u, -0.3, 0.8),
            "drive-saturation",
            {"upper": 0.8, "lower": -0.3},
        ),
        (
            lambda u: u - np.clip(u, -0.1, 0.3),
            "dead-zone",
            {"upper": 0.3, "lower": -0.1},
        ),
    ],
    ids=["of one sign", "lower", "upper", "two levels", "two edges"],
)
def test_a_drive_that_differs_by_side_is_named_with_its_levels(bend, name, told):
    given = bent_first(POLE, bend, (0.4, 1.0), 41, 0.004, (DRIVE, OUTPUT))
    base = Model("pole", DRIVE, OUTPUT, (POLE,))
    answer = search("amplifier", given, base, "linear", vocabulary=CURVES)
    (effect,) = answer.content["effects"]
    assert (answer.content["verdict"], effect["name"]) == ("named", name)
    assert effect["confidence"] > 0.8
    found = {key: item["value"] for key, item in effect["parameters"].items()}
    assert found == pytest.approx(told, abs=0.01)
