"""A host that nothing holds, of a velocity: its spring may not be so soft as none."""

import math

import numpy as np
import pytest

from hystbench.gap.asked import Asked
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.inside.insert_law import how_it_moves
from hystbench.gap.inside.one_coordinate import likeliest
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.record import Channel, Record
from tests.gap.closing import closed_beside
from tests.gap.made import evidence_of
from tests.gap.searched import among
from tests.gap.small import block

CHANNELS = Channel("u", "V"), Channel("speed", "rad/s")
DT, NOISE = 1.0, 2.0


def staircase():
    """A motor's speed at some voltages, from the first of them on."""
    random = np.random.default_rng(0)
    u = np.repeat(random.uniform(2.0, 7.6, 12), 40)
    plant = block(
        "mechanism",
        mass=0.36,
        damping=0.031,
        stiffness=0.0,
        output="velocity",
        hold="zero-order",
        start="moving",
    )
    y = plant.simulate(u, u, DT) + NOISE * random.standard_normal(len(u))
    return (Record("steps", DT, u, y, *CHANNELS, "measured"),)


def host(records, **spring):
    numbers = {"mass": 0.36, "damping": 0.031, "output": "velocity", **spring}
    chain = (block("mechanism", hold="zero-order", **numbers),)
    free = (Free(0, "damping"),)
    sample = ScoredSamples.of(records)
    return ModelState(chain, records, sample, free=free, hold="zero-order")


def test_a_spring_so_soft_that_the_way_is_lost_in_rounding_is_none():
    """In balance with the first voltage the mass would stand at 1e19 rad."""
    records = staircase()
    score = Score.plain(ScoredSamples.of(records), NOISE**2)
    soft = host(records, stiffness=4e-19, start="settled")
    free = host(records, stiffness=0.0, start="moving")
    assert likeliest([soft], score) is None
    found = likeliest([soft, free], score)
    assert found is not None
    way = np.ptp(np.cumsum(records[0].y) * DT) / 2
    assert 0.9 * way < how_it_moves(found.state, "rad").reach < 1.1 * way


@pytest.mark.parametrize("law", ["friction", "stiffness-hardening"])
def test_a_motion_of_first_order_is_of_a_mass_or_of_a_spring(law):
    """A current in a coil behind diodes, and a damper that a spring pulls."""
    rng, dt, count, fine = np.random.default_rng(4), 1e-3, 600, 40
    records = []
    for name, use in (("one", "fit"), ("other", "fit"), ("held", "hold-out")):
        u = np.repeat(rng.normal(0, 1.5, count // 10), 10)
        y, x = np.empty(count), 0.0
        for k, volts in enumerate(u.tolist()):
            y[k] = x
            for _ in range(fine):
                lost = 0.9 * math.tanh(x / 0.2) if law == "friction" else 2.0 * x**3
                x += dt / fine * (volts - 0.8 * x - lost) / 0.01
        y += 0.004 * rng.standard_normal(count)
        about = Channel("drive", "V"), Channel("answer", "A"), "twin", use
        records.append(Record(name, dt, u, y, *about))
    given = evidence_of("coil", records, "zero-order", 0.004, "voltage", "none-known")
    likely = Asked(vocabulary=among("friction", "stiffness-hardening"))
    content = closed_beside("linear", given, likely)
    assert [effect["name"] for effect in content["effects"]] == [law]
    assert content["gap"]["after"] < 1.3 * 0.004
