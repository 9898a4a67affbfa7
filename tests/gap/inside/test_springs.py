"""Springs and stops of devices written without a block."""

import numpy as np
import pytest

from tests.gap.oscillator import NOISE, best


def nothing(force, v):
    return 0.0


def leaves_noise(item, noise=NOISE):
    return np.sqrt(np.mean(item.state.residual**2)) < 1.2 * noise


def test_stops_of_which_one_is_nearer_are_found_with_both_clearances():
    def stopped(q):
        return 60.0 * q + 400.0 * max(q - 0.1, 0.0) - 400.0 * max(-q - 0.18, 0.0)

    offered = ["stop", "stiffness-hardening", "slider-with-gap"]
    item = best(nothing, stopped, offered, noise=20 * NOISE)
    assert (item.effects, item.forms) == (("stop",), ("sides: both, uneven",))
    law = item.state.chain[1]
    assert law.gap + law.centre == pytest.approx(0.1, abs=0.003)
    assert law.gap - law.centre == pytest.approx(0.18, abs=0.003)
    assert law.contact_stiffness == pytest.approx(400.0, rel=0.05)
    assert leaves_noise(item, 20 * NOISE)


def test_a_spring_whose_force_levels_off_is_told_as_one():
    def levels_off(q):
        return 60.0 * q / np.sqrt(1.0 + (q / 0.15) ** 2)

    item = best(nothing, levels_off, ["stiffness-hardening", "hysteretic-force"])
    assert item.effects == ("stiffness-hardening",)
    host, law, *_ = item.state.chain
    assert host.stiffness < 0.6  # of a spring beside it
    assert law.stiffness == pytest.approx(60.0, rel=0.02)
    assert law.reach == pytest.approx(0.15, rel=0.02)
    assert leaves_noise(item)


def test_a_weight_that_alone_holds_an_arm_is_gravity_and_no_softer_spring():
    def weight(q):
        return 60.0 * np.sin(q)

    offered = ["gravity", "stiffness-hardening"]
    item = best(nothing, weight, offered, turns="rad")
    assert (item.effects, item.forms) == (("gravity",), ("without a spring",))
    assert item.state.chain[0].stiffness == 0.0
    assert item.state.chain[1].amplitude == pytest.approx(60.0, rel=0.02)
    assert item.state.freedom == 0.0  # as many numbers as a spring has


def test_springs_across_the_motion_are_one_spring_and_no_stop_beside_it():
    """Two of them, each 0.15 long at rest: they turn as the mass goes."""

    def across(q):
        return 60.0 * q + 90.0 * q * (1.0 - 0.15 / np.hypot(0.15, q))

    item = best(nothing, across, ["stiffness-hardening", "stop", "asymmetry"])
    assert item.effects == ("stiffness-hardening",)
    host, law, *_ = item.state.chain
    assert law.name == "transverse-springs"
    assert host.stiffness == pytest.approx(60.0, rel=0.02)
    assert law.stiffness == pytest.approx(90.0, rel=0.02)
    assert law.reach == pytest.approx(0.15, rel=0.02)
    assert leaves_noise(item)
