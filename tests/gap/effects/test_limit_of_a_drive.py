"""What tells a limit of a drive from a material: a drive is straight below it."""

import numpy as np
import pytest

from hystbench.blocks.prandtl_ishlinskii import PrandtlIshlinskii
from hystbench.model import Model
from hystbench.record import Channel
from tests.gap.made import bent_first
from tests.gap.searched import search

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
