"""The start of an identified base, judged again beside what was named."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from hystbench.gap.effects import effects
from hystbench.gap.fitting.state import Added
from hystbench.gap.naming.begun_otherwise import begun_as_named
from hystbench.gap.records.floor import Floor
from hystbench.gap.simulation.simulation import Simulation
from hystbench.model import Model
from tests.gap.made import CURRENT, DISPLACEMENT, record
from tests.gap.small import block, state_of

DT, LAG, NOISE = 0.01, 2.0, 1e-3
FLOOR = Floor(NOISE, "declared")
LAST = np.exp(-DT / LAG)


def moved(u):
    """A lag of two seconds, at rest before; a staircase of the input drives it."""
    behind = np.concatenate([[0.0], u[:-1]])
    return lfilter([1 - LAST], [1, -LAST], behind)


@pytest.fixture(scope="module")
def records():
    rng = np.random.default_rng(0)
    given = []
    for name in ("a", "b"):
        u = 1.0 + np.cumsum(rng.standard_normal(1000)) / 30
        y = moved(u + 0.3 * u**2) + NOISE * rng.standard_normal(1000)
        given.append(record(u, y, name=name, dt=DT))
    return tuple(given)


def base(start):
    lag = block(
        "transfer-function",
        numerator=(1.0,),
        denominator=(LAG, 1.0),
        hold="zero-order",
        start=start,
    )
    return Model("linear", CURRENT, DISPLACEMENT, (lag,))


def named(base, records, *beside):
    curve = block("asymmetry", coefficient=0.3)
    bent = Added("asymmetry", "material", "square", (0,), {}, 1)
    added = (bent, *(Added("drift", "sensor", "path", (), {}, 1) for _ in beside))
    chain = (curve, *base.chain)
    return state_of(
        chain, records, hold="zero-order", added=added, beside=tuple(beside)
    )


def a_path(records):
    simulation = Simulation(base("rest").chain, records)
    offered = effects()["drift"].variants(simulation)
    return next(x.beside for x in offered if x.form == "path"), {}


@pytest.mark.parametrize("taken", ["moving", "settled"])
def test_a_start_that_hid_the_curve_goes_with_it(records, taken):
    found = named(base(taken), records, a_path(records))
    begun = begun_as_named(base(taken), found, records, FLOOR)
    assert begun == base("rest")


def test_a_base_that_begins_rightly_stays(records):
    found = named(base("rest"), records, a_path(records))
    assert begun_as_named(base("rest"), found, records, FLOOR) is None


def test_a_start_is_not_taken_where_the_path_does_better(records):
    """Records that truly drift: no start of a lag explains that."""
    time = DT * np.arange(len(records[0].u))
    drifting = tuple(
        replace(item, y=item.y + sign * 0.3 * np.sin(0.9 * time))
        for item, sign in zip(records, (1.0, -1.0), strict=True)
    )
    found = named(base("settled"), drifting, a_path(drifting))
    assert begun_as_named(base("settled"), found, drifting, FLOOR) is None


def test_without_a_path_of_each_record_nothing_is_asked(records):
    found = named(base("settled"), records)
    assert begun_as_named(base("settled"), found, records, FLOOR) is None
    whole = replace(found, chain=base("settled").chain)
    assert begun_as_named(base("settled"), whole, records, FLOOR) is None


def test_a_path_alone_shows_no_start(records):
    """Nothing else was named that could have hidden one."""
    found = named(base("settled"), records, a_path(records))
    alone = replace(found, added=found.added[1:])
    assert begun_as_named(base("settled"), alone, records, FLOOR) is None
