"""A hysteresis has a loop; many plays bend to curves that have none."""

import numpy as np

from hystbench.blocks.transfer_function import TransferFunction
from hystbench.model import Model
from hystbench.record import Channel
from tests.gap.examples import plain_play
from tests.gap.made import bent_first
from tests.gap.searched import among, search

DRIVE, OUTPUT = Channel("drive", "V"), Channel("output", "V")
POLE = TransferFunction(numerator=(1.0,), denominator=(4e-3, 1.0), hold="linear")


def answer(bend, *names):
    given = bent_first(POLE, bend, (0.4, 1.0), 41, 0.004, (DRIVE, OUTPUT))
    base = Model("pole", DRIVE, OUTPUT, (POLE,))
    content = search("made", given, base, "linear", vocabulary=among(*names)).content
    return content["verdict"], [item["name"] for item in content["effects"]], content


def soft_corner(u):
    return np.logaddexp(0.0, 12 * (u + 0.3)) / 12 - 0.3


def test_a_curve_of_no_known_form_is_no_hysteresis():
    verdict, names, content = answer(soft_corner, "hysteresis")
    assert (verdict, names) == ("unnamed", ["hysteresis"])
    assert "has no loop" in content["reason"]


def test_a_law_of_few_numbers_that_leaves_as_little_stands_before_such_a_curve():
    corner = answer(soft_corner, "hysteresis", "drive-saturation")
    assert corner[:2] == ("named", ["drive-saturation"])


def test_what_has_a_loop_stays_a_hysteresis():
    def loop(u):
        return u + 0.5 * plain_play(u, 0.2) - 0.3 * plain_play(u, 0.5)

    verdict, names, _ = answer(loop, "hysteresis", "drive-saturation")
    assert (verdict, names) == ("named", ["hysteresis"])
