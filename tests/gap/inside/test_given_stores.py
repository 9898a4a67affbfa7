"""Forces in stores that a user gives with numbers that are a little off."""

import numpy as np
import pytest

from hystbench.blocks.store import Store
from hystbench.gap.bases.roughly_known import roughly_known
from hystbench.gap.fitting.on_records import start_state
from hystbench.gap.fitting.score import Score
from hystbench.gap.inside.insert_law import laws_for
from hystbench.gap.inside.possible_hosts import hosts
from hystbench.model import Model
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record

DT, COUNT = 0.2, 400
PUMP, LEVEL = Channel("pump", "V"), Channel("level", "cm")
TANK = Store(gain=0.6, rate=0.8, start="settled", hold="zero-order")


@pytest.mark.parametrize("about", [False, True])
def test_stores_hold_laws_also_where_their_numbers_and_timing_are_known_about(about):
    """The timing that is free there stands before the stores, and is none of them."""
    u = np.repeat(np.random.default_rng(2).uniform(2.0, 6.0, COUNT // 20), 20)
    record = Record("run", DT, u, TANK.simulate(u, u, DT), PUMP, LEVEL, "measured")
    base = Model("tank", PUMP, LEVEL, (TANK,))
    if about:
        base = roughly_known(base, (record,))
        assert base.chain[0].name == "input-delay"
    start, floor = start_state((record,), base, "zero-order", 0.02)
    score = Score.plain(start.sample, floor.rms**2)
    (host,) = hosts(start, Quantities(output="level"), False, score)
    assert host.kind == "stores"
    assert "overflow" in laws_for(host.fitted)
