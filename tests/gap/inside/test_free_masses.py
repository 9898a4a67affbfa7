"""A host that nothing holds, of a velocity: its spring may not be so soft as none."""

import numpy as np

from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.inside.insert_law import how_it_moves
from hystbench.gap.inside.one_coordinate import likeliest
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.record import Channel, Record
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
