"""Curves and loops, written by hand, before and behind linear dynamics."""

import numpy as np
import pytest

from hystbench.blocks.transfer_function import TransferFunction
from hystbench.model import Model
from hystbench.record import Channel, Record
from tests.gap.made import play
from tests.gap.searched import among, search

DT, COUNT, NOISE = 0.1, 800, 0.003
POWER, WAY = Channel("power", "W"), Channel("way", "mm")
LAG = TransferFunction(numerator=(1.0,), denominator=(1.5, 1.0), hold="zero-order")
LIKELY = among(
    *("asymmetry", "backlash", "hysteresis", "creep", "saturation", "dead-zone"),
    *("sensor-nonlinearity", "drive-lag", "sensor-lag", "friction"),
)


def loop(x):
    """Plays of an x that levels off: three of one weight beside a straight line."""
    bent = np.tanh(x)
    return 0.4 * bent + sum(0.3 * play(bent, r) for r in (0.1, 0.2, 0.4))


def square(u):
    return u + 0.2 * (u - 2.0) ** 2


def delayed(x):
    return LAG.simulate(x, x, DT)


def crept(x):
    """A part follows in four seconds."""
    slow, now = np.empty(len(x)), x[0]
    for k, value in enumerate(x):
        slow[k] = now
        now += (value - now) * DT / 4.0
    return x + 0.2 * slow


def named(made, middle=0.0):
    random = np.random.default_rng(8)
    records = []
    for k in range(2):
        steps = np.repeat(random.uniform(-1.5, 1.5, COUNT // 20), 20)
        steps[:20] = 0.0  # at rest, where a play begins
        u = middle + np.convolve(steps, np.ones(10) / 10, "same")
        y = made(u) + NOISE * random.standard_normal(COUNT)
        records.append(Record(f"run-{k}", DT, u, y, POWER, WAY, "measured", "fit"))
    base = Model("lag", POWER, WAY, (LAG,))
    return search("wire", tuple(records), base, "zero-order", vocabulary=LIKELY).content


def test_a_square_about_a_bias_is_an_asymmetry():
    """About zero it would change the gain and the offset at the bias too."""
    content = named(lambda u: delayed(square(u)), 2.0)
    (effect,) = content["effects"]
    assert effect["name"] == "asymmetry"
    for key, value in (("coefficient", 0.2), ("about", 2.0)):
        assert effect["parameters"][key]["value"] == pytest.approx(value, rel=0.01)


def test_a_play_before_the_dynamics_is_a_backlash():
    content = named(lambda u: delayed(play(u, 0.3)))
    (effect,) = content["effects"]
    assert effect["name"] == "backlash"
    assert effect["parameters"]["half_width"]["value"] == pytest.approx(0.3, rel=0.02)


@pytest.mark.parametrize(
    ("made", "position"),
    [(lambda u: delayed(loop(u)), 0), (lambda u: loop(delayed(u)), 1)],
)
def test_a_loop_is_found_before_the_dynamics_and_behind(made, position):
    content = named(made)
    assert [effect["name"] for effect in content["effects"]] == ["hysteresis"]
    variants = content["ranking"][0]["variants"]
    best = min(variants, key=lambda variant: variant["score"])
    assert best["position"] == position
    assert content["fit"]["explained"] > 0.99


def test_two_laws_of_few_numbers_are_no_hysteresis_of_many():
    """Plays with envelopes bend as a square does and lag as a creep does, nearly."""
    content = named(lambda u: crept(delayed(square(u))), 2.0)
    assert {x["name"] for x in content["effects"]} == {"asymmetry", "creep"}
    assert content["fit"]["explained"] > 0.995
