"""Forces that remember the way, of devices written without a block."""

import math

import numpy as np
import pytest

from hystbench.blocks.iwan_force import IwanForce
from hystbench.gap.effects.forces import EVEN_FORCE
from hystbench.gap.thresholds import SCALE
from tests.gap.inside_host import each_alone
from tests.gap.oscillator import NOISE, best, spring, tried


def stiffens(force, v):
    """Wen's equation with stiffness 40, beta 2, gamma -3."""
    return 40.0 * v - 2.0 * abs(v) * force + 3.0 * v * abs(force)


def test_a_loop_that_grows_stiffer_on_loading_is_a_hysteretic_force():
    item = best(stiffens)
    assert item.effects == ("hysteretic-force",)
    law = item.state.chain[1]
    assert law.name == "bouc-wen-force"
    assert law.stiffness == pytest.approx(40.0, rel=0.15)
    assert law.beta == pytest.approx(2.0, rel=0.15)
    assert law.gamma == pytest.approx(-3.0, rel=0.15)
    rms = np.sqrt(np.mean(item.state.residual**2))
    assert rms < 1.5 * NOISE


def test_a_spring_that_loses_nothing_is_no_hysteretic_force():
    """With a beta of zero the law is elastic: then it is another effect."""

    def rubber(q):
        return 60.0 * q + math.copysign(40.0 / 3.0 * math.expm1(3.0 * abs(q)), q)

    item = best(lambda force, v: 0.0, rubber, ["hysteretic-force"])
    assert item.effects == ()


def test_a_spring_that_softens_and_loses_nothing_is_none_either():
    """Bouc and Wen's loop with a sharing of one runs back along its way: a magnet."""

    def magnet(q):
        return 40.0 * q + math.copysign(3.0 * math.expm1(-abs(q) / 0.1), q)

    offered = ["hysteretic-force", "stiffness-hardening"]
    found = tried(lambda force, v: 0.0, magnet, offered, by=each_alone)
    assert [item.effects for item in found] == [(), ("stiffness-hardening",)]


def test_elements_that_slip_one_after_the_other_are_a_hysteretic_force():
    """Forty of them, of one stiffness: they slip between zero and a way of 0.3."""
    slips = (np.arange(40) + 0.5) / 40

    def held(force, v):
        most = slips * 0.3  # a stiffness of one each
        return np.where((np.abs(force) >= most) & (force * v > 0), 0.0, v)

    item = best(held, offered=["hysteretic-force"])
    assert item.effects == ("hysteretic-force",)
    law = item.state.chain[1]
    # The first of them slips at an eightieth of the way.
    assert 0.0 <= law.first_slip < 0.05
    assert law.stiffness == pytest.approx(40.0, rel=0.05)
    assert law.slip_distance == pytest.approx(0.3, rel=0.1)
    assert law.exponent == pytest.approx(0.0, abs=0.15)
    assert np.sqrt(np.mean(item.state.residual**2)) < 3 * NOISE


def test_elements_that_all_slip_at_once_are_friction_and_clearly_so():
    """One stop: friction that gives way by 0.05 before it slides at 2 N."""

    def held(force, v):
        return 0.0 if abs(force) >= 2.0 and force * v > 0 else 40.0 * v

    found = tried(held, spring, ["friction", "hysteretic-force"], noise=10 * NOISE)
    scores = {item.effects: item.score for item in found}
    rival = scores.pop(("hysteretic-force",))
    assert min(scores, key=lambda effects: scores[effects]) == ("friction",)
    assert rival > scores["friction",] + 10 * SCALE


def test_a_loop_of_exponent_two_is_one_force_and_no_friction_beside_it():
    def yields_late(force, v):
        """Bouc and Wen's equation: 6 N at most, in a way of 0.1, a sharing of 0.4."""
        share = 0.4 + 0.6 * np.sign(force * v)
        return 60.0 * v * (1.0 - (force / 6.0) ** 2 * share)

    item = best(yields_late, offered=["hysteretic-force", "friction"])
    assert item.effects == ("hysteretic-force",)
    law = item.state.chain[1]
    assert law.exponent == 2.0
    assert law.largest == pytest.approx(6.0, rel=0.1)
    assert law.yield_distance == pytest.approx(0.1, rel=0.1)
    assert law.sharing == pytest.approx(0.4, abs=0.1)
    assert np.sqrt(np.mean(item.state.residual**2)) < 2 * NOISE


@pytest.mark.parametrize(
    ("exponent", "beyond"), [(EVEN_FORCE, 0.5), (EVEN_FORCE - 1, 1 / 11), (0.0, 0.99)]
)
def test_below_an_exponent_most_of_the_force_gives_way_at_once(exponent, beyond):
    """Of the force, the integral of ``r^(1 + exponent)``, over two decades of ways."""
    block = IwanForce(
        stiffness=1.0, slip_distance=1.0, exponent=exponent, first_slip=0.01
    )
    shares, thresholds = block.elements()
    forces = shares * thresholds
    late = forces[thresholds > 0.1].sum() / forces.sum()
    assert late == pytest.approx(beyond, abs=0.06)
