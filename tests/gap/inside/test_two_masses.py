"""Friction at the driven side of a flexible shaft: in two modes at once."""

import numpy as np
import pytest

from hystbench.blocks.gain import Gain
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.possible_hosts import hosts
from hystbench.gap.inside.two_masses import further_modes_of
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record
from tests.gap.inside_host import search
from tests.gap.solved import motion

MOTOR, LOAD, SHAFT, DAMPER, FRICTION = 0.01, 0.03, 60.0, 0.05, 0.25
NOISE = 0.02
TIME = np.arange(2000) * 0.002


def turned(level):
    """Motor speed under a torque, less friction; by an ODE solver."""
    u = level * (np.sin(2 * np.pi * 1.3 * TIME) + 0.6 * np.sin(2 * np.pi * 15.1 * TIME))

    def moves(t, x):
        v, w, lag = x
        twist = SHAFT * lag + DAMPER * (v - w)
        held = DAMPER * v + FRICTION * np.tanh(v / 0.3)
        return [(np.interp(t, TIME, u) - twist - held) / MOTOR, twist / LOAD, v - w]

    y = motion(moves, [0.0] * 3, TIME, TIME[1], rtol=1e-6, atol=1e-6)
    y = y + NOISE * np.random.default_rng(int(10 * level)).standard_normal(len(y))
    channels = Channel("torque", "N*m"), Channel("speed", "rad/s")
    return Record(f"level {level}", TIME[1], u, y, *channels, "measured", "fit")


@pytest.fixture(scope="module")
def base():
    """The joint without its friction, as a transfer function of third order."""
    below = np.array([LOAD, DAMPER, SHAFT])
    above = np.polyadd(
        np.polymul([MOTOR, DAMPER], below), np.polymul([LOAD, 0.0], below[1:])
    )
    block = TransferFunction(
        numerator=tuple(below.tolist()),
        denominator=tuple(above.tolist()),
        hold="linear",
    )
    records = tuple(turned(level) for level in (0.4, 1.2))
    return ModelState(
        (block, Gain(value=1.0)), records, ScoredSamples.of(records), hold="linear"
    ).settled()


def test_friction_of_the_motor_is_found_with_its_number(base):
    score = Score.plain(base.sample, NOISE**2)
    asked = Quantities("torque", "velocity")
    given = [x for x in hosts(base, asked, True, score) if "attached" in x.words]
    assert len(given) == 1
    offered = ["friction", "drag", "dead-zone"]
    found = search(given[0].fitted, score, offered=offered)
    best = min(found, key=lambda item: item.score)
    assert best.effects == ("friction",)
    law = best.state.chain[best.state.added[0].blocks[0]]
    assert law.coulomb == pytest.approx(FRICTION, rel=0.05)
    load = next(x for x in best.state.chain if x.name == "attached-mass")
    assert load.mass == pytest.approx(LOAD, rel=0.05)
    assert np.sqrt(np.mean(best.state.residual**2)) < 1.3 * NOISE


def test_hosts_of_one_kind_alone_are_given_when_asked(base):
    score = Score.plain(base.sample, NOISE**2)
    asked = base, Quantities("torque", "velocity"), True, score
    every = list(hosts(*asked))
    for kind in ("coordinate", "two masses"):
        wanted = [x.words for x in every if x.kind == kind]
        assert wanted
        assert [x.words for x in hosts(*asked, kinds=(kind,))] == wanted
    assert len({x.kind for x in every}) > 1


def test_a_base_of_two_poles_has_no_second_mass(base):
    block = TransferFunction(numerator=(1.0,), denominator=(1.0, 0.2, 40.0))
    assert further_modes_of(base.with_blocks({0: block})) == []
    assert len(further_modes_of(base)) == 1
