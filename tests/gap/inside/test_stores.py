"""Effects of stores: two tanks, written here by small steps of Euler."""

import math
from dataclasses import replace
from itertools import islice

import numpy as np
import pytest

from hystbench.blocks.input_delay import InputDelay
from hystbench.blocks.parameter import HUGE
from hystbench.blocks.store import Store
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases.load import load_base
from hystbench.gap.effects import effects
from hystbench.gap.effects.law import Filled
from hystbench.gap.fitting.edit_chain import rearranged, without_effect
from hystbench.gap.fitting.least_squares import Fitted, judged
from hystbench.gap.fitting.parameters import parameters_of
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.inside import linear_stores as of_stores
from hystbench.gap.inside.choose import chosen
from hystbench.gap.inside.combine_forces import ForceSearch
from hystbench.gap.inside.insert_law import how_it_fills
from hystbench.gap.inside.known_host import with_best_beside_free
from hystbench.gap.inside.linear_stores import (
    all_are_seen_filling,
    may_be_stores,
    store_hosts,
    stores,
)
from hystbench.gap.inside.one_coordinate import best_host
from hystbench.gap.inside.possible_hosts import hosts
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record
from tests.gap.inside_host import each_alone, search
from tests.gap.searched import among
from tests.gap.searched import search as decided

DT, COUNT, FINE = 4.0, 600, 40
NOISE = 0.02
LAWS = ["outflow", "overflow", "sensor-nonlinearity"]
CHANNELS = Channel("pump", "V"), Channel("level", "V")


def tanks(root, height, seed=3, powers=None, rates=None, pump=False):
    """One tank above another; what the upper one spills is lost."""
    rng = np.random.default_rng(seed)
    u = np.clip(3 + np.repeat(rng.normal(0, 1.5, COUNT // 20), 20), 0, 7)
    upper, lower, out = 60.0, 50.0, []
    powers = powers or ((0.5, 0.5) if root else (1.0, 1.0))
    rates = rates or ((0.35, 0.3) if root else (0.04, 0.03))
    step = DT / FINE
    for volts in u.tolist():
        out.append(lower)
        flow = (
            1.6 * max(volts - 1.5, 0.0) if pump else volts
        )  # it lifts nothing at first
        for _ in range(FINE):
            leaves = rates[0] * max(upper, 0.0) ** powers[0]
            lower += step * (leaves - rates[1] * max(lower, 0.0) ** powers[1])
            upper = min(upper + step * (flow - leaves), height)
    noise = NOISE * rng.standard_normal(COUNT)
    y = np.array(out) / 20
    return Record("run", DT, u, y + noise, *CHANNELS, "measured")


def found(record):
    score = Score(
        next(stores((record,), "zero-order", NOISE, 2)).sample,
        np.zeros((COUNT, 0)),
        4e-4,
    )
    host = best_host(list(stores((record,), "zero-order", NOISE, 2)), score)
    return chosen(search(host, score), score.floor), score


def test_an_outflow_by_the_root_of_the_level_is_named():
    best, _ = found(tanks(root=True, height=np.inf))
    assert best.effects == ("outflow",)
    assert all(store.exponent == pytest.approx(0.5, abs=0.1)
               for store in best.state.chain)  # fmt: skip
    left = np.sqrt(np.mean(best.state.residual**2))
    assert left < 1.5 * NOISE


def over_a_weir(height, weir, seed=6):
    """One linear tank, whose wall has a notch."""
    rng = np.random.default_rng(seed)
    u = np.clip(3 + np.repeat(rng.normal(0, 1.5, COUNT // 20), 20), 0, 7)
    level, out = 50.0, []
    for volts in u.tolist():
        out.append(level)
        for _ in range(FINE):
            over = weir * max(level - height, 0.0) ** 1.5
            level += DT / FINE * (volts - 0.03 * level - over)
    noise = NOISE * rng.standard_normal(COUNT)
    return Record("run", DT, u, np.array(out) / 20 + noise, *CHANNELS, "measured")


def test_an_overflow_over_a_weir_is_told_with_its_edge():
    record = over_a_weir(height=90.0, weir=0.02)
    assert record.y.max() * 20 > 105  # the level goes on rising above the edge
    begun = next(stores((record,), "zero-order", NOISE, 1))
    score = Score(begun.sample, np.zeros((COUNT, 0)), NOISE**2)
    best = chosen(search(best_host([begun], score), score), score.floor)
    assert best.effects == ("overflow",)
    (store,) = best.state.chain
    # In volts, of which one is 20 of the level.
    assert store.height == pytest.approx(90 / 20, rel=0.02)
    assert store.weir == pytest.approx(0.02 * 20**0.5, rel=0.1)
    assert np.sqrt(np.mean(best.state.residual**2)) < 1.1 * NOISE
    errors = np.full(len(best.state.free), np.nan)
    told = parameters_of(best.state.added[0], best.state, errors)
    assert told["weir"]["unit"] == "V^-0.5/s"
    # One that spills at once has no weir to tell of.
    sharp = replace(best.state, chain=(replace(store, weir=HUGE),))
    assert "weir" not in parameters_of(best.state.added[0], sharp, errors)


@pytest.mark.parametrize("powers", [(1.0, 0.5), (0.5, 1.0)])
def test_the_law_may_be_in_either_of_a_slow_and_a_fast_store(powers):
    """Linear, either order does the same: the host cannot tell which is which."""
    slow, fast = 0.2, 0.06  # the root's is the slow one at these levels
    rates = (fast, slow) if powers[0] == 1.0 else (slow, fast)
    record = tanks(root=None, height=np.inf, powers=powers, rates=rates)
    begun = next(stores((record,), "zero-order", NOISE, 2))
    score = Score(begun.sample, np.zeros((COUNT, 0)), NOISE**2)
    every = islice(hosts(begun, Quantities(output="level"), True, score), 3)
    laws = ["outflow", "sensor-nonlinearity"]
    best = min(
        (
            chosen(
                each_alone(host.fitted, score, laws, other=host.unfitted_start),
                score.floor,
            )
            for host in every
        ),
        key=lambda item: item.score,
    )
    assert best.effects == ("outflow",)
    found = [store.exponent for store in best.state.chain]
    assert found == pytest.approx(powers, abs=0.1)
    assert np.sqrt(np.mean(best.state.residual**2)) < 1.5 * NOISE


def test_stores_in_the_other_order_keep_the_timing_of_a_base():
    """A base that takes its input late begins with a delay, and so does each host."""
    record = tanks(root=True, height=np.inf)
    begun = next(stores((record,), "zero-order", NOISE, 2))
    late = InputDelay(delay_s=DT, hold="zero-order")
    start = ModelState((late, *begun.chain), (record,), begun.sample, hold="zero-order")
    score = Score.plain(start.sample, NOISE**2)
    both = [
        host
        for host in islice(hosts(start, Quantities(output="level"), True, score), 3)
        if host.unfitted_start is not None
    ]
    assert both
    for host in both:
        assert host.unfitted_start.chain[0] == host.alone.chain[0] == late
        assert len(host.unfitted_start.chain) == len(host.alone.chain)


def test_overflow_is_named_and_goes_out_again():
    best, _ = found(tanks(root=False, height=90.0))
    assert best.effects == ("overflow",)
    state = best.state
    assert np.sqrt(np.mean(state.residual**2)) < 1.5 * NOISE
    # The inflow is counted in volts of the pump: the upper store's unit is ours.
    assert state.chain[0].height == pytest.approx(90.0, rel=0.03)
    short = without_effect(state, 0)
    assert all(store.height > 1e20 for store in short.chain)
    assert not {free.parameter for free in short.free} & {"height", "caught"}
    assert short.added == ()


def test_a_given_store_spills_below_what_it_would_rise_to_without():
    """A base without the overflow rises far beyond what was ever measured."""
    tank = Store(gain=20.0, rate=0.5, exponent=0.5, start="settled", hold="zero-order")
    spills = replace(tank, height=900.0)
    u = 0.6 + 0.3 * np.sin(np.arange(COUNT) / 60.0)
    high, y = (block.simulate(u, u, DT) for block in (tank, spills))
    assert high.max() > 1.2 * y.max()
    noise = np.random.default_rng(5).standard_normal(COUNT)
    record = Record("run", DT, u, y + noise, *CHANNELS, "measured")
    given = ModelState((tank,), (record,), ScoredSamples.of((record,)))
    score = Score.plain(given.sample, 1.0)
    best = chosen(search(Fitted(given, judged(given, score)), score), 1.0)
    assert best.effects == ("overflow",)
    assert best.state.chain[0].height == pytest.approx(900.0, abs=1.0)


def test_of_a_level_that_is_measured_below_zero_no_overflow_begins_there():
    tank = Store(gain=20.0, rate=0.5, exponent=0.5, start="settled", hold="zero-order")
    u = 0.6 + 0.3 * np.sin(np.arange(COUNT) / 60.0)
    y = tank.simulate(u, u, DT) - 1e6  # a gauge with another zero
    record = Record("run", DT, u, y, *CHANNELS, "measured")
    given = ModelState((tank,), (record,), ScoredSamples.of((record,)))
    laws = effects()["overflow"].stored(how_it_fills(given))
    assert all(law.values[0]["height"] > 0 for law in laws)


def test_linear_stores_need_no_effect():
    best, _ = found(tanks(root=False, height=np.inf))
    assert best.effects == ()


def given_tank(record, **values):
    """A given base: a transfer function of one pole, from how much to how much."""
    block = TransferFunction(
        numerator=(20.0,), denominator=(60.0, 1.0), start="settled", **values
    )
    return ModelState(
        (block,), (record,), ScoredSamples.of((record,)), hold="zero-order"
    )


def test_stores_stand_for_a_given_tank_and_their_fit_counts_as_an_effect():
    record = tanks(root=True, height=np.inf)
    start = given_tank(record, hold="zero-order")
    score = Score.plain(start.sample, NOISE**2)
    one = next(hosts(start, Quantities(output="level"), False, score))
    assert one.counts == 1
    # Until something is named in it, it does what the base does.
    (store,) = one.alone.chain
    assert store.rate == pytest.approx(1 / 60, rel=1e-3)
    assert one.alone.power(NOISE**2) == pytest.approx(start.power(NOISE**2), rel=0.02)
    # What swings is no tank.
    swings = TransferFunction(numerator=(20.0,), denominator=(60.0**2, 20.0, 1.0))
    other = replace(start, chain=(swings,))
    assert not may_be_stores(other)
    assert may_be_stores(start)


def test_an_outflow_goes_out_again_from_behind_a_delay():
    """The places of its numbers move with the stores."""
    best, _ = found(tanks(root=True, height=np.inf))
    late = InputDelay(delay_s=DT)
    state = best.state
    moved = {k: k + 1 for k in range(len(state.chain))}
    behind = rearranged(state, (late, *state.chain), moved)
    short = without_effect(behind, 0)
    assert short.chain[0] == late
    assert all(store.exponent == 1.0 for store in short.chain[1:])


def test_an_output_that_is_negative_is_no_level():
    record = tanks(root=False, height=np.inf)
    below = Record("below", DT, record.u, record.y - 3, *CHANNELS, "measured")
    assert list(stores((below,), "zero-order", NOISE, 1)) == []


def test_a_level_may_be_negative_by_its_noise():
    record = tanks(root=True, height=np.inf)
    low = record.y - record.y[0] - NOISE
    begun = Record("low", DT, record.u, low - low.min() - NOISE, *CHANNELS, "measured")
    assert min(begun.y) < 0
    assert list(stores((begun,), "zero-order", NOISE, 1))


def test_of_several_records_each_may_begin_where_it_rests():
    """Of two runs from different levels no one number is both their starts."""
    rng = np.random.default_rng(8)
    t = np.arange(COUNT) * DT
    records = []
    for first in (2.0, 5.0):
        steps = np.repeat(rng.normal(0, 1, COUNT // 20), 20)
        u = first + np.where(t > 40, 0.8 * steps, 0.0)
        level = tank(u, (first / 0.8) ** 2)
        noisy = level + NOISE * rng.standard_normal(COUNT)
        records.append(Record("run", DT, u, noisy, *CHANNELS, "measured"))
    begun = list(stores(tuple(records), "zero-order", NOISE, 1))
    score = Score(begun[0].sample, np.zeros((2 * COUNT, 0)), NOISE**2)
    best = chosen(search(best_host(begun, score), score), score.floor)
    assert best.effects == ("outflow",)
    state = best.state
    assert [store.start for store in state.chain] == ["settled"]
    assert np.sqrt(np.mean(state.residual**2)) < 1.5 * NOISE


def tank(u, level):
    """One tank that loses 0.8 times the root of its level, in turns of a minute."""
    out, step = [], DT / 60 / FINE
    for flow in u.tolist():
        out.append(level)
        for _ in range(FINE):
            level += step * (flow - 0.8 * math.sqrt(max(level, 0.0)))
    return np.array(out)


@pytest.mark.parametrize(
    ("effect", "read"),
    [
        ("sensor-nonlinearity", lambda y: 0.3 * y + 0.07 * y**2),
        ("dead-zone", lambda y: y),
    ],
)
def test_a_curve_before_or_behind_stores_is_named_with_the_outflow(effect, read):
    record = tanks(root=True, height=np.inf, pump=effect == "dead-zone")
    record = Record("run", DT, record.u, read(record.y), *CHANNELS, "measured")
    best, _ = found(record)
    assert set(best.effects) == {"outflow", effect}
    assert np.sqrt(np.mean(best.state.residual**2)) < 1.5 * NOISE


def test_overflow_is_named_beside_a_base_of_stores_that_was_given():
    """The base has the law of the outflow; nothing of it is free."""
    record = tanks(root=True, height=60.0)
    upper = Store(
        gain=1.0, rate=0.35, start_level=60.0, output="outflow", hold="zero-order"
    )
    lower = Store(gain=0.05, rate=0.3 / np.sqrt(20), start_level=2.5, hold="linear")
    begun = next(stores((record,), "zero-order", NOISE, 2))
    start = replace(begun, chain=(upper, lower), free=()).settled()
    score = Score(start.sample, np.zeros((COUNT, 0)), NOISE**2)
    (host,) = hosts(start, Quantities(output="level"), False, score)
    best = chosen(search(host.fitted, score), score.floor)
    assert best.effects == ("overflow",)
    assert np.sqrt(np.mean(best.state.residual**2)) < 1.5 * NOISE
    assert best.state.chain[0].height == pytest.approx(60.0, rel=0.03)
    assert best.state.chain[0].rate == upper.rate


@pytest.mark.parametrize("about", [False, True])
def test_a_base_that_is_the_tangent_of_the_outflow_lacks_its_root(about):
    """A laboratory's linear tank, about the level of 26: its rate is no rate of a root.

    Nor where its numbers may be off by a tenth.
    """
    rate, level, count = 0.9, 26.0, 800
    rng = np.random.default_rng(4)
    u = np.clip(4.5 + np.repeat(rng.normal(0, 1.5, count // 20), 20), 0.5, 9)
    step, now, out = DT / FINE / 20, level, []
    for volts in u.tolist():
        out.append(now)
        for _ in range(FINE):
            now += step * (volts - rate * math.sqrt(max(now, 0.0)))
    y = np.array(out) + NOISE * rng.standard_normal(count)
    record = Record("run", DT / 20, u, y, *CHANNELS, "measured")
    slope = rate / (2 * np.sqrt(level))
    linear = Store(
        gain=1.0,
        rate=slope,
        exponent=1.0,
        bias=slope * level - rate * np.sqrt(level),
        start_level=level,
        hold="zero-order",
    )
    numbers = ("gain", "rate", "bias") if about else ()
    free = tuple(
        Free(0, x, None, *_ends(getattr(linear, x)), given=getattr(linear, x))
        for x in numbers
    )
    sample = ScoredSamples.of((record,))
    start = ModelState((linear,), (record,), sample, free, hold="zero-order").settled()
    score = Score.plain(start.sample, NOISE**2)
    (host,) = hosts(start, Quantities(output="level"), False, score)
    best = chosen(search(host.fitted, score), score.floor)
    assert best.effects == ("outflow",)
    (store,) = best.state.chain
    assert store.rate == pytest.approx(rate, rel=0.02)
    assert store.exponent == pytest.approx(0.5, abs=0.02)
    assert np.sqrt(np.mean(best.state.residual**2)) < 1.1 * NOISE
    # The root is what was found, although it is what a store has unless it says.
    told = parameters_of(best.state.added[0], best.state, np.zeros(9))
    assert told["exponent"]["value"] == pytest.approx(0.5, abs=0.02)
    # Without the root its rate is known as well as before.
    short = without_effect(best.state, 0)
    assert sorted(short.free) == sorted(host.fitted.state.free)


@pytest.mark.parametrize(("fast", "seen"), [(0.7, True), (0.9, False)])
def test_a_store_that_fills_within_a_sample_is_no_host(fast, seen):
    """The samples, four seconds apart, show rates of up to pi / 4 a second."""
    slow, other = (Store(gain=1.0, rate=x, exponent=1.0) for x in (0.02, fast))
    record = tanks(root=False, height=np.inf)
    state = ModelState((slow, other), (record,), ScoredSamples.of((record,)))
    assert all_are_seen_filling(state) == seen


def test_stores_that_are_not_seen_filling_are_no_hosts(monkeypatch):
    record = tanks(root=False, height=np.inf)
    base = TransferFunction(numerator=(1.0,), denominator=(50.0, 1.0))
    start = ModelState((base,), (record,), ScoredSamples.of((record,)))
    score = Score.plain(start.sample, NOISE**2)
    assert next(store_hosts(start, True, score), None) is not None
    monkeypatch.setattr(of_stores, "all_are_seen_filling", lambda state: False)
    assert next(store_hosts(start, True, score), None) is None


def test_another_rate_is_no_other_law_of_a_tank_with_a_free_outlet():
    tank = Store(gain=1.0, rate=0.9, exponent=0.5, start_level=20.0)
    filled = Filled(((0, tank, 30.0),), known=True)
    changed = list(effects()["outflow"].stored(filled))
    assert [item.form for item in changed] == ["power", "weir", "power"]
    assert changed[0].free == ((0, "exponent"),)


def test_water_over_a_straight_edge_flows_by_the_level_to_the_power_of_a_half_more():
    tank = Store(gain=1.0, rate=0.9, exponent=1.0, start_level=20.0)
    changed = list(effects()["outflow"].stored(Filled(((0, tank, 30.0),))))
    (weir,) = (item for item in changed if item.form == "weir")
    assert weir.values[0]["exponent"] == 1.5
    # As much leaves the tank where it is half full.
    assert weir.values[0]["rate"] * 15.0**1.5 == pytest.approx(0.9 * 15.0)
    assert weir.free == ((0, "rate"),)


def test_a_weir_below_the_middle_of_the_levels_is_an_outlet_and_no_overflow():
    """Nearly all levels lie above the edge of one: that is the law of an outlet."""
    upper = Store(gain=1.0, rate=0.9, exponent=1.0, start_level=20.0)
    stores_ = ((0, upper, 30.0), (1, upper, 40.0))
    weirs = [
        law
        for law in effects()["overflow"].stored(Filled(stores_))
        if law.form.endswith("over a weir")
    ]
    assert {law.form.partition(",")[0] for law in weirs} == {"last", "all", "upper"}
    for law in weirs:
        for place in law.values:
            least, most = law.ranges[place, "height"]
            assert (least, most) == (pytest.approx(stores_[place][2] / 2), np.inf)
            assert law.values[place]["height"] > least
    best, _ = found(tanks(root=None, height=np.inf, powers=(1.5, 1.5)))
    assert best.effects == ("outflow",)


def _ends(value):
    """Give the tolerance of a number, and the ends of its range."""
    size = 0.1 * abs(value)
    return size, value - size, value + size


def test_a_drift_is_told_beside_the_outflow_of_a_tank():
    """A level sensor that drifts by a few percent had made the outflow unnamed."""
    rng = np.random.default_rng(5)
    made, count = [], 400
    for k in range(2):
        u = np.repeat(rng.uniform(1.0, 4.0, count // 20), 20)
        level, now = np.empty(count), 5.0
        for i, volts in enumerate(u.tolist()):
            level[i] = now
            for _ in range(20):
                now += 0.05 * (0.5 * volts - 0.5 * math.sqrt(now))
        way = np.linspace(-1.0, 1.0, count)
        drift = 0.06 * level.std() * ((-1) ** k * way + 0.5 * way**2)
        y = level + drift + 0.01 * level.std() * rng.standard_normal(count)
        made.append(Record(f"run-{k}", 1.0, u, y, *CHANNELS, "measured", "fit"))
    evidence = Evidence("tank", tuple(made), (), "zero-order")
    base, _ = load_base("linear", evidence)
    level = Quantities(output="level")
    likely = among(
        *("outflow", "overflow", "drift", "creep", "sensor-nonlinearity"),
    )
    content = decided(
        "tank", made, base, "zero-order", quantities=level, vocabulary=likely
    ).content
    assert content["verdict"] == "named"
    assert {x["name"] for x in content["effects"]} == {"outflow", "drift"}


def heated(start, seed):
    """A body that loses heat with its temperature, which it begins with; Euler."""
    rng = np.random.default_rng(seed)
    power = np.repeat(rng.uniform(1.0, 4.0, COUNT // 20), 20)
    warm, y = start, np.empty(COUNT)
    for k, watts in enumerate(power):
        y[k] = warm
        for _ in range(FINE):
            warm += DT / FINE * (0.1 * watts - 0.04 * warm)
    noise = NOISE * rng.standard_normal(COUNT)
    channels = Channel("heater", "W"), Channel("temperature", "degC")
    return Record(f"run-{seed}", DT, power, y + noise, *channels, "measured", "fit")


def test_where_a_linear_store_begins_is_no_effect():
    """No start of a transfer function gives it: it was named hysteresis, at .98."""
    record = heated(start=25.0, seed=1)
    base, _ = load_base("linear", Evidence("body", (record,), (), "zero-order"))
    thermal = Quantities("power", "temperature")
    found = decided("body", (record,), base, "zero-order", quantities=thermal)
    assert found.content["verdict"] == "no-gap"
    assert not found.content["effects"]
    assert "a store stands in place of the base; then" in found.content["reason"]
    (store,) = (x for x in found.base.chain if isinstance(x, Store))
    assert store.exponent == 1.0
    assert store.rate == pytest.approx(0.04, rel=0.02)


def test_a_base_of_stores_has_no_mass_whose_numbers_could_be_free():
    record = tanks(root=False, height=np.inf)
    tank = Store(gain=1.0, rate=0.02, exponent=1.0)
    state = ModelState((tank,), (record,), ScoredSamples.of((record,)))
    score = Score.plain(state.sample, NOISE**2)
    given = [Fitted(state, 0.0)]
    assert with_best_beside_free(given, ForceSearch(lambda _: {}, score)) == given
