"""Play in the shaft between a motor and its load: two bodies that turn freely."""

import numpy as np
import pytest

from hystbench.blocks.gain import Gain
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.possible_hosts import hosts
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record
from tests.gap.inside_host import each_alone

MOTOR, LOAD, SHAFT, DAMPER, DRAG, PLAY = 0.002, 0.002, 12.0, 0.02, 0.02, 0.02
DT, NOISE = 0.002, 0.05


def turned(level, seed):
    """Motor speed under a staircase of torque, by small steps."""
    random = np.random.default_rng(seed)
    u = level * np.repeat(random.uniform(-1, 1, 90), 8)
    twist = motor = load = 0.0
    fine, out = 20, []
    for push in np.repeat(u, fine).tolist():
        out.append(motor)
        into = twist - min(max(twist, -PLAY), PLAY)
        torque = SHAFT * into + DAMPER * (motor - load) * (into != 0.0)
        motor += DT / fine * (push - DRAG * motor - torque) / MOTOR
        load += DT / fine * (torque - DRAG * load) / LOAD
        twist += DT / fine * (motor - load)
    y = np.array(out[::fine]) + NOISE * random.standard_normal(len(u))
    channels = Channel("torque", "N*m"), Channel("speed", "rad/s")
    return Record(f"level {level}", DT, u, y, *channels, "measured", "fit")


@pytest.fixture(scope="module")
def base():
    """The drive without play, as a transfer function of third order."""
    below = np.polymul([LOAD, DRAG], [1.0, 0.0])
    shaft = np.array([DAMPER, SHAFT])
    up = np.polyadd(below, shaft)
    body = np.polyadd(np.polymul([MOTOR, DRAG], up), np.polymul([LOAD, DRAG], shaft))
    block = TransferFunction(
        numerator=tuple(up.tolist()),
        denominator=tuple(body.tolist()),
        hold="zero-order",
    )
    records = (turned(0.8, 1), turned(2.0, 2))
    return ModelState(
        (block, Gain(value=1.0)), records, ScoredSamples.of(records), hold="zero-order"
    ).settled()


def test_it_is_a_stop_in_the_place_of_the_shaft_s_spring(base):
    score = Score.plain(base.sample, NOISE**2)
    asked = base, Quantities("torque", "velocity"), True, score
    (host,) = hosts(*asked, kinds=("structure",))
    assert [x.name for x in host.fitted.state.chain][:2] == ["structure", "other-modes"]
    offered = ["stop", "stiffness-hardening"]
    best = min(each_alone(host.fitted, score, offered), key=lambda item: item.score)
    assert best.effects == ("stop",)
    before, after = host.fitted.state.power(NOISE**2), best.state.power(NOISE**2)
    assert after < 0.05 * before
    (mode,) = best.state.chain[0].stiffness
    own = best.state.chain[1].contact_stiffness * best.state.chain[0].joint[0] ** 2
    assert mode < 0.1 * own  # the shaft carries little within its play
    assert mode + own == pytest.approx(SHAFT * (1 / MOTOR + 1 / LOAD), rel=0.1)


def test_both_masses_are_tried_as_well(base):
    """As friction of the motor acts there, and not in the shaft."""
    score = Score.plain(base.sample, NOISE**2)
    asked = base, Quantities("torque", "velocity"), True, score
    assert "two masses" in {x.kind for x in hosts(*asked)}
