"""Effects inside the dynamics: linear hosts, forces in them, windows of a free mass."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.signal import lsim

from hystbench.blocks import registry
from hystbench.blocks.drive_lag import DriveLag
from hystbench.blocks.exponential_curve import ExponentialCurve
from hystbench.blocks.friction_force import FrictionForce
from hystbench.blocks.gain import Gain
from hystbench.blocks.input_delay import InputDelay
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.other_modes import OtherModes
from hystbench.blocks.resonance import Resonance
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases.linear import IdentifiedModel, with_its_numbers_free
from hystbench.gap.effects import effects
from hystbench.gap.effects.law import Law, Moved
from hystbench.gap.fitting.least_squares import Fitted
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Added, Free, ModelState
from hystbench.gap.inside.average_force import evened
from hystbench.gap.inside.beginnings import Beginnings
from hystbench.gap.inside.choose import chosen
from hystbench.gap.inside.combine_forces import (
    starts,
    with_one_fewer,
)
from hystbench.gap.inside.fitted_numbers import re_tuning
from hystbench.gap.inside.given_hosts import is_seen_moving
from hystbench.gap.inside.insert_law import (
    Times,
    how_it_moves,
    laws_for,
    with_law,
)
from hystbench.gap.inside.named_inside import (
    Inside,
    beats_base,
    beats_chain,
    named_inside,
)
from hystbench.gap.inside.one_coordinate import (
    best_host,
    free_masses,
    one_coordinate,
    same_as,
)
from hystbench.gap.inside.possible_hosts import hosts
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.records.floor import Floor
from hystbench.gap.records.free_mass import decay_of_free_mass, windows
from hystbench.gap.records.nuisance import left_over
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.thresholds import CERTAIN
from hystbench.model import Model
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record
from tests.gap.inside_host import each_alone, search
from tests.gap.small import block, state_of
from tests.gap.solved import motion

DT = 0.005
NOISE = 0.02
FLOOR = Floor(NOISE, "declared")
TIME = np.arange(1600) * DT
SPRINGS = ["gravity", "stiffness-hardening", "stop"]
"""A weight that turns, and what it may be taken for."""
BEFORE = ["drive-saturation", "asymmetry", "dead-zone", "stiffness-hardening"]
"""Curves before a mass, and one of its spring that bends its motion as well."""


def record(name, u, y, units=("mm", "N"), use="fit"):
    channels = Channel("in", units[0]), Channel("out", units[1])
    return Record(name, DT, u, y, *channels, "measured", use)


def damper(size, frequency, seed):
    """A device that is moved: viscous and dry friction, written without a block."""
    x = size * np.sin(2 * np.pi * frequency * TIME) + 0.2 * size * np.sin(9.1 * TIME)
    v = np.gradient(x, DT)
    noise = NOISE * np.random.default_rng(seed).standard_normal(len(x))
    return record(f"run-{seed}", x, 0.03 * v + 4.0 * np.tanh(v / 3.0) + 1.0 + noise)


@pytest.fixture(scope="module")
def found():
    records = tuple(damper(s, f, k) for k, (s, f) in enumerate([(2, 1.3), (5, 0.7)]))
    begun = list(one_coordinate(records, Quantities("position", "force"), "linear"))
    score = Score.plain(begun[0].sample, NOISE**2)
    return search(best_host(begun, score), score, offered=["friction", "drag"])


def test_friction_of_a_device_that_is_moved_is_found_with_its_numbers(found):
    best = min(found, key=lambda item: item.score)
    assert best.effects == ("friction",)
    assert best.forms == ("smooth",)
    law = next(x for x in best.state.chain if x.name == "smooth-friction")
    assert law.coulomb == pytest.approx(4.0, rel=0.02)
    assert law.velocity_scale == pytest.approx(3.0, rel=0.05)
    rms = np.sqrt(np.mean(best.state.residual**2))
    assert rms == pytest.approx(NOISE, rel=0.1)


def best_of_moved(given, noise, offered):
    """Give the best that is found in a device that is moved."""
    begun = one_coordinate(tuple(given), Quantities("position", "force"), "linear")
    sample = ScoredSamples.of(tuple(given))
    score = Score.plain(sample, noise**2)
    found = search(best_host(list(begun), score), score, offered=offered)
    return min(found, key=lambda item: item.score)


def test_smooth_friction_may_fall_with_the_speed():
    """Stribeck's curve of a device that is moved, written without a block."""
    given = []
    for seed, size in enumerate((2.0, 5.0)):
        x = size * np.sin(2 * np.pi * 0.7 * TIME) + 0.2 * size * np.sin(9.1 * TIME)
        v = np.gradient(x, DT)
        level = 2.0 + 1.5 * np.exp(-((v / 4.0) ** 2))
        noise = NOISE * np.random.default_rng(seed).standard_normal(len(x))
        given.append(record(f"{seed}", x, 0.03 * v + level * np.tanh(v / 2) + noise))
    best = best_of_moved(given, NOISE, ["friction", "drag"])
    assert best.effects == ("friction",)
    law = next(x for x in best.state.chain if x.name == "smooth-friction")
    assert law.coulomb == pytest.approx(2.0, rel=0.1)
    assert law.static_excess == pytest.approx(1.5, rel=0.1)
    assert law.stribeck_velocity == pytest.approx(4.0, rel=0.1)
    rms = np.sqrt(np.mean(best.state.residual**2))
    assert rms == pytest.approx(NOISE, rel=0.1)


def test_friction_of_bristles_is_found_with_its_numbers():
    """LuGre's model of a device that is moved, solved without a block."""
    given = []
    for seed, size in enumerate((0.5, 3.0)):

        def bends(t, z, size=size):
            v = size * (4.4 * np.cos(4.4 * t) + 1.8 * np.cos(9.1 * t))
            slides = 2.0 + 1.0 * np.exp(-((v / 3.0) ** 2))
            return v - abs(v) * z * 100.0 / slides

        z = motion(bends, [0.0], TIME, DT, rtol=1e-8)
        x = size * (np.sin(4.4 * TIME) + 1.8 / 9.1 * np.sin(9.1 * TIME))
        noise = NOISE * np.random.default_rng(seed).standard_normal(len(x))
        given.append(
            record(f"{seed}", x, 100.0 * z + 0.03 * np.gradient(x, DT) + noise)
        )
    best = best_of_moved(
        given, NOISE, ["friction", "hysteretic-force", "slider-with-gap"]
    )
    assert best.effects == ("friction",)
    assert best.forms == ("LuGre",)
    law = next(x for x in best.state.chain if x.name == "lugre-force")
    assert law.coulomb == pytest.approx(2.0, rel=0.02)
    assert law.presliding_distance == pytest.approx(3.0 / 100.0, rel=0.02)
    assert law.static_excess == pytest.approx(1.0, rel=0.05)
    assert law.stribeck_velocity == pytest.approx(3.0, rel=0.05)


def test_plays_that_slip_from_a_first_way_on_are_a_hysteretic_force():
    """Rubber, as five stops of unequal stiffness, written without a block."""
    given, ways = [], np.array([0.05, 0.12, 0.25, 0.5, 1.0])
    for seed, size in enumerate((0.3, 1.2)):
        x = size * (np.sin(4.4 * TIME) + 0.4 * np.sin(13.1 * TIME))
        held, force = np.zeros(5), []
        for step in np.diff(x, prepend=x[0]):
            held = np.clip(held + step, -ways, ways)
            force.append(np.array([9.0, 6.0, 3.5, 2.0, 1.0]) @ held)
        noise = 10 * NOISE * np.random.default_rng(seed).standard_normal(len(x))
        given.append(record(f"{seed}", x, np.array(force) + 18.0 * x + noise))
    best = best_of_moved(
        given, 10 * NOISE, ["friction", "hysteretic-force", "slider-with-gap"]
    )
    assert best.effects == ("hysteretic-force",)
    assert best.forms == ("plays from a first slip on",)
    law = next(x for x in best.state.chain if x.name == "iwan-force")
    assert law.first_slip * law.slip_distance == pytest.approx(0.05, rel=0.5)


def test_a_host_without_a_force_stands_first(found):
    assert found[0].effects == ()
    assert found[0].score > min(item.score for item in found) + 100


def test_a_law_promises_what_its_numbers_do_that_start_at_zero():
    """A spring that is stiffer on one side has a square; its fit starts without."""
    x = 5.0 * np.sin(7 * TIME) + 1.5 * np.sin(19 * TIME)
    y = 2.0 * x + 0.1 * np.gradient(x, DT) + 0.05 * x**2
    given = (record("one", x, y + NOISE * np.sin(TIME**2 * 99)),)
    begun = list(one_coordinate(given, Quantities("position", "force"), "linear"))
    score = Score.plain(begun[0].sample, NOISE**2)
    host = best_host(begun, score)
    laws = laws_for(host)["stiffness-hardening"]
    whole = Beginnings.all_of(host.state, score)
    put_in = starts(host, host.state, "stiffness-hardening", laws, whole)
    promised = {item.forms: item.score for item in put_in}
    assert promised["square and cube",] < promised["cube",] - 200


def test_a_law_whose_slopes_run_away_is_left_out(monkeypatch):
    """It may run as it begins, and diverge at a step beside that."""
    x = 5.0 * np.sin(7 * TIME)
    given = (record("one", x, 2.0 * x + 0.05 * x**3 + NOISE * np.sin(TIME**2 * 99)),)
    begun = list(one_coordinate(given, Quantities("position", "force"), "linear"))
    score = Score.plain(begun[0].sample, NOISE**2)
    host = best_host(begun, score)
    laws = laws_for(host)["stiffness-hardening"]
    whole = Beginnings.all_of(host.state, score)
    slopes = "hystbench.gap.inside.combine_forces.of_zeros"
    monkeypatch.setattr(slopes, lambda state: np.full((len(state.sample), 1), np.inf))
    assert list(starts(host, host.state, "stiffness-hardening", laws, whole)) == []


def test_a_store_has_no_impedance():
    level = Quantities("position", "level")
    assert list(one_coordinate((damper(2, 1.3, 0),), level, "linear")) == []


def mass(spring):
    """A mass that a force moves, by small steps of Euler, and a spring."""
    rng = np.random.default_rng(5)
    u = 3 * np.sin(2 * np.pi * 0.5 * TIME) + np.cumsum(rng.standard_normal(1600)) * 1e-3
    fine, q, v, out = 20, 0.0, 0.0, []
    for force in u.tolist():
        out.append(q)
        for _ in range(fine):
            v += DT / fine * (force - 0.8 * v - 0.2 * ((v > 0) - (v < 0)) - spring * q)
            q += DT / fine * v
    return record("mass", u, np.array(out), ("N", "m"))


MOVES = Quantities("force", "position")


def transfer(records):
    """A linear base of first order, as one is identified."""
    first = TransferFunction(numerator=(1.0, 0.0), denominator=(1.0, 1.0))
    return ModelState((first,), records, ScoredSamples.of(records), hold="zero-order")


def hosted(records, noise):
    """A mass that fits the records best, and the score of such noise."""
    begun = one_coordinate(tuple(records), MOVES, "zero-order")
    sample = ScoredSamples.of(tuple(records))
    score = Score.plain(sample, noise**2)
    return best_host(list(begun), score), score


def test_a_mass_without_a_spring_is_known_by_its_records():
    decay = decay_of_free_mass([mass(0.0)], MOVES)
    assert decay == pytest.approx(1 / 0.8, rel=0.2)  # mass over damping
    assert decay_of_free_mass([mass(30.0)], MOVES) is None
    assert decay_of_free_mass([mass(0.0)], Quantities("position", "force")) is None
    assert decay_of_free_mass([replace(mass(0.0), use="hold-out")], MOVES) is None


def test_forces_are_tried_with_the_timing_of_the_base_and_without():
    """What a linear model takes for timing may be the phase that a force turns."""
    host, score = hosted([mass(30.0)], 1e-3)
    state = host.state
    early = InputDelay(delay_s=0.0, lead_s=DT / 2, hold=state.hold)
    free = tuple(item._replace(block=item.block + 1) for item in state.free)
    start = replace(state, chain=(early, *state.chain), free=free).settled()
    chains = [item.fitted.state.chain for item in hosts(start, MOVES, True, score)]
    firsts = [chain[0] for chain in chains]
    assert firsts[0] == early
    assert isinstance(firsts[-1], Mechanism)
    alone = [item.alone.chain[0].name for item in hosts(start, MOVES, True, score)]
    assert alone == [block.name for block in firsts]


@pytest.mark.parametrize(
    ("units", "kinds", "count"),
    [
        (("N", "mm"), MOVES, 0),
        (("mm", "N"), Quantities("position", "force"), 1),
    ],
)
def test_where_the_base_is_a_gain_no_mass_is_seen(units, kinds, count):
    """As of a slow piezoelectric stack: its loop is one of what drives it."""
    u = np.sin(2.1 * TIME)
    given = (record("slow", u, 3.0 * u, units),)
    start = ModelState((Gain(value=3.0, offset=0.0),), given, ScoredSamples.of(given))
    score = Score.plain(start.sample, NOISE**2)
    assert len(list(hosts(start, kinds, True, score))) == count


def test_what_a_given_base_is_the_same_as_is_sought_once(monkeypatch):
    """It does not depend on what was measured: an offset taken off changes nothing."""
    w = 6.0
    base = TransferFunction(numerator=(0.3 * w**2,), denominator=(1.0, 0.9, w**2))
    measured = mass(30.0)
    offset = replace(measured, y=measured.y - 0.05)
    sought = []
    monkeypatch.setattr(
        "hystbench.gap.inside.one_coordinate.one_coordinate",
        lambda *given: sought.append(given) or one_coordinate(*given),
    )
    found = [
        same_as(
            ModelState((base,), (own,), ScoredSamples.of((own,)), hold="linear"),
            MOVES,
            NOISE**2,
        )
        for own in (measured, offset)
    ]
    assert len(sought) == 1
    (first, second) = (state.chain[0] for state in found)
    assert first == second
    assert first.stiffness / first.mass == pytest.approx(w**2, rel=1e-3)
    assert [state.records[0] for state in found] == [measured, offset]


def test_what_no_mass_on_a_spring_does_is_seen_on_one_record(monkeypatch):
    """Half of the base is a mode and half a rigid path, as a record of jumps shows."""
    base = Resonance(
        frequency_hz=1.0, damping_ratio=0.1, participation=0.5, hold="linear"
    )
    u, rng = np.sin(2.1 * TIME), np.random.default_rng(2)
    records = tuple(
        record(str(k), x, base.simulate(x, x, DT) + 0.1 * rng.standard_normal(len(x)))
        for k, x in enumerate((u, 2.0 * np.sign(u), 0.5 * u))
    )
    sought = []
    monkeypatch.setattr(
        "hystbench.gap.inside.one_coordinate.one_coordinate",
        lambda given, *more: sought.append(given) or one_coordinate(given, *more),
    )
    start = ModelState((base,), records, ScoredSamples.of(records), hold="linear")
    assert same_as(start, MOVES, 0.1**2) is None
    (given,) = sought
    assert [item.name for item in given] == ["1"]


def test_drag_of_a_loose_mass_whose_acceleration_is_measured():
    """By small steps of Euler: linear, it looks like a mass on a soft spring."""
    given, fine = [], 20
    for seed, size in enumerate((1.0, 2.0, 4.0)):
        u = size * (np.sin(2.1 * TIME) + 0.7 * np.sin(5.3 * TIME + seed))
        v, out = 0.0, []
        for force in u.tolist():
            out.append((force - 0.3 * v - 0.4 * v * abs(v)) / 0.5)
            for _ in range(fine):
                v += DT / fine * (force - 0.3 * v - 0.4 * v * abs(v)) / 0.5
        noise = NOISE * np.random.default_rng(seed).standard_normal(len(u))
        given.append(record(f"{seed}", u, np.array(out) + noise, ("N", "m/s^2")))
    start = transfer(tuple(given))
    score = Score.plain(start.sample, NOISE**2)
    every = hosts(start, Quantities("force", "acceleration"), True, score)
    first = ((x, x.fitted.state.chain[0]) for x in every)
    host = next(x for x, b in first if b.name == "mechanism" and b.stiffness == 0.0)
    found = search(host.fitted, score, ["drag", "friction", "drive-saturation"])
    best = min(found, key=lambda item: item.score)
    assert best.effects == ("drag",)
    assert best.state.chain[1].coefficient == pytest.approx(0.4, rel=0.03)


def test_windows_begin_at_rest_and_at_zero():
    whole = mass(0.0)
    cut = windows(whole)
    assert len(cut) > 3
    assert sum(map(len, cut)) <= len(whole)
    fastest = np.abs(np.gradient(whole.y, DT)).max()
    for window in cut:
        assert window.y[0] == 0.0
        assert abs(window.y[1] - window.y[0]) / DT < 0.05 * fastest


def test_what_a_velocity_at_the_first_sample_does_is_left_out():
    whole = replace(mass(0.0), decay_s=1 / 0.8)
    plain = replace(whole, decay_s=None)
    pushed = replace(whole, y=whole.y + 0.3 * whole.of_start[:, 0])
    sample = ScoredSamples.of([whole])
    assert np.abs(sample.take([whole.y]) - sample.take([pushed.y])).max() < 1e-12
    assert np.abs(ScoredSamples.of([plain]).take([whole.y - pushed.y])).max() > 0.05
    residual, scored = left_over(pushed, whole.y, None)
    assert scored.all()
    assert np.abs(residual).max() < 1e-12
    assert whole.digest != plain.digest


def test_a_window_knows_which_of_its_samples_were_measured():
    lost = np.zeros(len(TIME), dtype=bool)
    lost[700:740] = True
    cut = windows(replace(mass(0.0), interpolated=lost))
    assert all(len(window.counted) == len(window) for window in cut)
    assert sum(int((~window.counted).sum()) for window in cut) == 40


def test_where_the_place_does_not_matter_no_force_depends_on_it():
    moved = Moved(reach=1.0, speed=1.0, force=1.0, anywhere=True)
    offered = {
        name for name, item in effects().items() if any(item.in_mechanism(moved))
    }
    assert {"friction", "drag", "hysteretic-force"} <= offered
    assert not {"stop", "stiffness-hardening", "gravity"} & offered


def test_what_is_offered_does_not_need_a_spring_that_pulls_back():
    """The stiffness of an impedance that was fitted may be a little below zero."""
    moved = Moved(reach=1.0, speed=1.0, force=1.0, stiffness=-0.3)
    offered = {
        name for name, item in effects().items() if any(item.in_mechanism(moved))
    }
    assert {"friction", "hysteretic-force", "slider-with-gap"} <= offered
    assert all(len(list(effects()[name].in_mechanism(moved))) for name in offered)


@pytest.mark.parametrize(("unit", "size_of_one"), [("rad", 1.0), ("deg", 180 / np.pi)])
def test_a_weight_that_swings_far_is_told_as_gravity_and_not_as_a_softer_spring(
    unit, size_of_one
):
    def swing(u, fine=20):
        angle, rate, found = 0.0, 0.0, []
        for moment in np.repeat(u, fine).tolist():
            found.append(angle)
            rate += DT / fine * (moment - 40.0 * math.sin(angle) - 0.8 * rate)
            angle += DT / fine * rate
        return np.array(found[::fine])

    random = np.random.default_rng(3)
    units = ("N*m", unit)
    records = []
    for size in (8.0, 25.0):
        u = size * np.repeat(random.uniform(-1, 1, 80), 20)
        y = size_of_one * (swing(u) + 1e-3 * random.standard_normal(1600))
        records.append(record(f"swing-{size:g}", u, y, units))
    assert max(float(np.abs(one.y).max()) for one in records) > 1.2 * size_of_one
    host, score = hosted(records, 1e-3 * size_of_one)
    tried = search(host, score, SPRINGS, turns=unit)
    best = min(tried[1:], key=lambda item: item.score)
    assert best.effects == ("gravity",)
    assert best.state.chain[1].amplitude == pytest.approx(40.0, rel=0.05)


def found_beside_an_arm(slope, sizes, damping, spring=30.0):
    """Search beside an arm whose spring is known; give the best of what was found."""
    random = np.random.default_rng(3)
    records = []
    for size in sizes:
        u = size * np.repeat(random.uniform(-1, 1, 80), 20)
        y = motion(slope, [0.0, 0.0], TIME, DT, u)
        y = y + 1e-3 * random.standard_normal(1600)
        records.append(record(f"arm-{size:g}", u, y, ("N*m", "rad")))
    arm = Mechanism(mass=1.0, damping=damping, stiffness=spring, hold="linear")
    given = tuple(records)
    start = ModelState((arm,), given, ScoredSamples.of(given)).settled()
    score = Score.plain(start.sample, 1e-6)
    host = Fitted(start, score.of(start.residual))
    found = search(host, score, SPRINGS, turns="rad")
    return min(found[1:], key=lambda item: item.score)


def test_a_weight_that_is_more_than_a_known_spring_is_found():
    """An arm that was measured lying, and then put up: its mode is twice as fast."""

    def slope(t, state, u):
        angle, rate = state
        moment = np.interp(t, TIME, u) - 90.0 * math.sin(angle)
        return [rate, moment - 0.3 * rate - 30.0 * angle]

    best = found_beside_an_arm(slope, (8.0, 25.0), damping=0.3)
    assert best.effects == ("gravity",)
    assert best.state.chain[1].amplitude == pytest.approx(90.0, rel=0.02)


def test_the_weight_of_a_level_arm_is_found_where_its_spring_was_slack():
    """Gravity pulls at once at the angle of zero: the spring carries nothing there."""

    def slope(t, state, u):
        angle, rate = state
        moment = np.interp(t, TIME, u) - 9.0 * np.cos(angle)
        return [rate, moment - 0.8 * rate - 30.0 * angle]

    best = found_beside_an_arm(slope, (4.0, 12.0), damping=0.8)
    assert best.effects == ("gravity",)
    weight = best.state.chain[1]
    # 9 cos q = 9 sin(q + pi / 2)
    assert weight.amplitude == pytest.approx(9.0, rel=0.02)
    assert weight.angle == pytest.approx(np.pi / 2, abs=0.02)
    assert np.sqrt(np.mean(best.state.residual**2)) < 1.1e-3


def test_the_weight_of_a_link_on_a_free_rotor_is_found():
    """A rotor that is known to be free, and whose place is seen, may bear a weight."""

    def slope(t, state, u):
        angle, rate = state
        return [rate, np.interp(t, TIME, u) - 9.0 * np.sin(angle) - 0.8 * rate]

    best = found_beside_an_arm(slope, (4.0, 9.0), damping=0.8, spring=0.0)
    assert best.effects == ("gravity",)
    assert best.state.chain[1].amplitude == pytest.approx(9.0, rel=0.02)
    assert np.sqrt(np.mean(best.state.residual**2)) < 1.1e-3


@pytest.mark.parametrize("decay_s", [None, 5.0])
def test_the_place_of_a_free_mass_is_not_seen_in_a_window(decay_s):
    """It begins at zero, wherever the mass is: no place can be told there."""
    u = np.sin(2 * np.pi * TIME)
    whole = record("motion", u, 0.1 * u, ("N", "m"))
    state = state_of(
        (block("mechanism", output="position", mass=1.0, damping=0.2, stiffness=0.0),),
        (replace(whole, decay_s=decay_s),),
    )
    assert how_it_moves(state, "").anywhere == (decay_s is not None)


def pushed(forces, q=0.0):
    """Move a mass of 1 kg on a spring of 60 N/m by forces, in small steps of Euler."""
    v, out = 0.0, []
    for force in np.repeat(forces, 20).tolist():
        out.append(q)
        v += DT / 20 * (force - 1.5 * v - 60.0 * q)
        q += DT / 20 * v
    return np.array(out[::20])


def test_a_limit_of_the_amplifier_before_a_mass_on_a_spring_is_found_there():
    random = np.random.default_rng(6)
    records = []
    for size in (2.0, 6.0):
        u = size * np.repeat(random.uniform(-1, 1, 160), 10)
        moved = pushed(np.clip(u, -3.0, 3.0))
        noise = 1e-4 * random.standard_normal(1600)
        records.append(record(f"{size:g}", u, moved + noise, ("N", "m")))
    host, score = hosted(records, 1e-4)
    best = min(search(host, score, BEFORE), key=lambda x: x.score)
    assert best.effects == ("drive-saturation",)
    limit, *_ = best.state.chain
    assert limit.limit == pytest.approx(3.0, rel=0.02)
    assert best.state.added[0].place == "before"


def test_a_force_by_the_square_of_a_current_is_found_before_a_mass_on_a_spring():
    random = np.random.default_rng(7)
    records = []
    for size in (0.2, 0.5):
        u = 1.0 + size * np.repeat(random.uniform(-1, 1, 160), 10)
        moved = pushed(3.0 * u**2, 3.0 * u[0] ** 2 / 60.0)
        noise = 1e-4 * random.standard_normal(1600)
        records.append(record(f"{size:g}", u, moved + noise, ("A", "m")))
    host, score = hosted(records, 1e-4)
    best = min(search(host, score, BEFORE), key=lambda x: x.score)
    assert best.effects == ("asymmetry",)
    assert best.state.added[0].place == "before"
    # What u + c u^2 bends by, over what it rises by, is that of u^2 about one ampere.
    coefficient = best.state.chain[0].coefficient
    assert coefficient / (1 + 2 * coefficient) == pytest.approx(0.5, rel=0.05)


def test_how_far_a_mass_goes_is_counted_behind_what_stands_before_it():
    """Else a further force would begin at a reach that is not the motion's."""
    u = np.sin(TIME)
    given = (record("sine", u, u, ("A", "m")),)
    machine = Mechanism(mass=1.0, damping=2.0, stiffness=60.0)
    plain, tenfold = (
        how_it_moves(ModelState(chain, given, ScoredSamples.of(given)), False)
        for chain in ((machine,), (Gain(value=10.0), machine))
    )
    assert tenfold.reach == pytest.approx(10 * plain.reach)
    assert tenfold.speed == pytest.approx(10 * plain.speed)
    assert tenfold.force == pytest.approx(10 * plain.force)


def test_a_slider_without_a_clearance_is_friction_and_no_rival_of_it():
    """A slider fits as well without a clearance; with one it is beyond doubt worse."""
    t = TIME
    x = 2 * np.sin(2 * np.pi * 1.3 * t) + 0.4 * np.sin(9.1 * t)
    way = np.zeros(len(t))
    for k in range(1, len(t)):  # slides at 0.1 mm: a stop operator
        way[k] = np.clip(way[k - 1] + x[k] - x[k - 1], -0.1, 0.1)
    noise = NOISE * np.random.default_rng(0).standard_normal(len(t))
    y = 0.03 * np.gradient(x, DT) + 40.0 * way + noise
    (begun,) = one_coordinate(
        (record("run", x, y),), Quantities("position", "force"), "linear"
    )
    score = Score.plain(begun.sample, NOISE**2)
    every = search(
        best_host([begun], score), score, offered=["friction", "slider-with-gap"]
    )
    best = min(every, key=lambda item: item.score)
    assert best.effects == ("friction",)
    others = [item.score for item in every if item is not best]
    assert min(others) > best.score + CERTAIN


def test_friction_that_gives_way_along_a_curve_is_no_hysteretic_force():
    """Dahl's friction by small steps of Euler: it slides on nearly all of its way."""
    random = np.random.default_rng(8)
    records = []
    for size in (3.0, 6.0):
        u = size * np.repeat(random.uniform(-1, 1, 80), 20)
        q, v, held, out = 0.0, 0.0, 0.0, []
        for force in np.repeat(u, 40).tolist():
            out.append(q)
            v += DT / 40 * (force - 1.5 * v - 60.0 * q - held)
            held += DT / 40 * v * (0.8 - ((v > 0) - (v < 0)) * held) / 4e-4  # N per m
            q += DT / 40 * v
        noise = 1e-5 * random.standard_normal(1600)
        records.append(record(f"{size:g}", u, np.array(out[::40]) + noise, ("N", "m")))
    host, score = hosted(records, 1e-5)
    offered = ["friction", "hysteretic-force"]
    best = chosen(search(host, score, offered), score.floor)
    assert best.effects == ("friction",)
    law = best.state.chain[1]
    if best.forms == ("LuGre",):  # without an excess at rest it is Dahl's
        assert law.static_excess < 0.01 * law.coulomb
        level, way = law.coulomb, law.presliding_distance
    else:
        assert best.forms == ("Dahl",)
        level, way = law.largest, law.yield_distance
    assert level == pytest.approx(0.8, rel=0.05)
    assert way == pytest.approx(4e-4, rel=0.25)


@pytest.mark.parametrize(
    ("mass", "damping", "stiffness", "seen"),
    [
        (1.0, 1.0, 40.0, True),  # 1 Hz
        (1.0, 1.0, 4e6, False),  # 318 Hz, of samples at 200 Hz
        (1.0, 4e3, 4e3, True),  # a slow lag of one second
        (1.0, 4e3, 4e6, False),  # both poles at 2000 / s
        (1.0, 4e3, 0.0, True),  # free: it adds up
    ],
)
def test_a_mass_that_is_faster_than_the_samples_is_not_seen_moving(
    mass, damping, stiffness, seen
):
    block = Mechanism(mass=mass, damping=damping, stiffness=stiffness)
    records = (record("run", np.zeros(len(TIME)), np.zeros(len(TIME)), ("N", "m")),)
    state = ModelState((block,), records, ScoredSamples.of(records))
    assert is_seen_moving(state) is seen


def test_an_effect_that_stood_for_another_goes_when_that_comes():
    """Of a car's drag and dry friction a delay was found first, and kept."""
    random = np.random.default_rng(11)
    u = 3.0 * np.repeat(random.uniform(-1, 1, 160), 10)
    moved = pushed(u) + 1e-4 * random.standard_normal(1600)
    host, score = hosted([record("run", u, moved, ("N", "m"))], 1e-4)
    names, state, known = ("friction", "input-delay", "drag"), host.state, []
    for name in names:
        law = laws_for(host)[name][0]
        state = with_law(state, name, law)
        known.append(Fitted(state, 0.0))
    known.append(Fitted(with_law(host.state, "drag", law), 0.0))
    fewer = with_one_fewer(known[2], known, score)
    assert {frozenset(item.effects) for item in fewer} == {
        frozenset(("friction", "drag")),
        frozenset(("input-delay", "drag")),
    }
    for item in fewer:
        assert np.isfinite(item.score)
    apart = [known[2], known[1], known[0]]  # no single of input-delay and drag
    (only,) = with_one_fewer(known[2], apart, score)
    assert only.effects == ("friction", "drag")
    # Of two effects each was tried alone: one of them by another law.
    pair, offered = known[1], laws_for(host)
    other = next(x for x in offered["friction"] if (x.form,) != known[0].forms)
    late = with_law(host.state, "input-delay", offered["input-delay"][0])
    delay = Fitted(late, 0.0)
    dry = Fitted(with_law(host.state, "friction", other), 0.0)
    tried = [host, dry, delay, pair]
    assert with_one_fewer(pair, tried, score) == []
    (again,) = with_one_fewer(pair, tried, score, by_laws=True)
    assert (again.effects, again.forms) == (("friction",), known[0].forms)


def test_a_curve_before_a_mass_leaves_what_drives_all_as_strong():
    """A force inside and another mode beside are driven as the mass is."""
    random = np.random.default_rng(12)
    u = 3.0 * np.repeat(random.uniform(-1, 1, 160), 10)
    host = Mechanism(mass=1.0, damping=1.5, stiffness=60.0, hold="linear")
    force = registry()["friction-force"](coulomb=1.0, presliding_distance=1e-4)
    beside = OtherModes(numerator=(0.5,), denominator=(1.0, 1.0, 400.0), hold="linear")
    records = (record("run", u, np.zeros(1600), ("N", "m")),)
    state = ModelState((host, force, beside), records, ScoredSamples.of(records))
    state = replace(state, free=(Free(0, "mass"), Free(0, "stiffness")))
    strong = ExponentialCurve(curvature=0.8)
    law = Law("exponential", strong, ("curvature",), "before")
    before = state.residual.std()
    assert with_law(state, "asymmetry", law).residual.std() > 1.5 * before
    even = evened(with_law(state, "asymmetry", law)).residual.std()
    assert even == pytest.approx(before, rel=0.25)


def test_a_force_beside_next_to_no_motion_leaves_the_host_as_it_is():
    """The damper that is nearest to it is larger than a block can hold."""
    u = 1e-27 * np.sin(2 * np.pi * 1.3 * TIME)
    given = (record("run", u, u, ("N", "mm")),)
    mass = Mechanism(mass=1.0, damping=0.1, stiffness=0.0, hold="linear")
    free = (Free(0, "damping"),)
    state = ModelState((mass,), given, ScoredSamples.of(given), free, hold="linear")
    dry = FrictionForce(coulomb=1e4, presliding_distance=1e-30)
    begun = with_law(state, "friction", Law("dry", dry, ("coulomb",)))
    assert evened(begun).chain == begun.chain


def test_a_spring_whose_acceleration_is_measured_is_no_friction():
    """Friction that gives way before it slides would be a spring to a loose mass."""
    random = np.random.default_rng(13)
    mode = Mechanism(
        mass=0.5,
        damping=0.4,
        stiffness=80.0,
        hold="zero-order",
        output="acceleration",
    )
    given = []
    for k, size in enumerate((1.0, 3.0)):
        u = size * np.repeat(random.uniform(-1, 1, 160), 10)
        y = mode.simulate(u, u, DT) + NOISE * random.standard_normal(1600)
        given.append(record(f"{k}", u, y, ("N", "m/s^2")))
    start = transfer(tuple(given))
    channels = given[0].input, given[0].output
    base = with_its_numbers_free(IdentifiedModel("linear", *channels, start.chain))
    moves = Quantities("force", "acceleration")
    found = named_inside(base, start, FLOOR, moves)
    assert found is None or not found.named.state.added


def test_a_free_mass_of_which_the_speed_is_seen_may_have_moved_before():
    rng = np.random.default_rng(3)
    half = rng.standard_normal(400)
    u = np.tile(np.convolve(np.tile(half, 2), np.ones(9) / 9)[400:800], 2)
    before = np.concatenate([u, u])
    truth = Mechanism(mass=1.0, damping=2.0, stiffness=0.0, output="velocity")
    y = truth.simulate(before, before, 0.01)[len(u) :]
    channels = Channel("voltage", "V"), Channel("speed", "rad/s")
    record = Record("run", 0.01, u, y, *channels, "measured", period_samples=400)
    for output, start in (("velocity", "repeating"), ("position", "rest")):
        for state in free_masses((record,), output, "zero-order"):
            assert state.chain[0].start == start


@pytest.mark.parametrize(
    ("mass", "effect", "expected"),
    [
        (1.3, "friction", "moved mass most, by 30 %"),
        (1.04, "friction", ""),
        (1.04, "gravity", ""),  # the spring was in part the weight
    ],
)
def test_a_host_of_a_given_base_tells_which_number_was_moved_far(
    mass, effect, expected
):
    """Nobody said that its numbers are free: a wrong mass would hide behind a name."""
    u = np.sin(2 * np.pi * 1.3 * TIME)
    given = (record("run", u, 12.0 * u, ("V", "mm")),)
    alone = Mechanism(mass=1.0, damping=0.5, stiffness=40.0)
    spring = 25.0 if effect == "gravity" else 39.0
    fitted = replace(alone, mass=mass, stiffness=spring)
    lag = DriveLag(time_constant_s=0.1)
    item = Added(effect, "before", "", (0,), {}, 1.0)
    names = ("mass", "damping", "stiffness")
    free = tuple(Free(1, name) for name in names)
    about = (given, ScoredSamples.of(given))
    state = ModelState((lag, fitted), *about, free=free, added=(item,))
    told = re_tuning(ModelState((alone,), *about), state)
    assert expected in told
    assert bool(told) == bool(expected)


@pytest.mark.parametrize(
    ("after", "pays"), [(10.9, False), (11.0, False), (11.9, True)]
)
def test_an_effect_that_makes_up_for_what_its_host_lacks_is_not_missing(after, pays):
    """The base's gain is 11 of 12: a host with an effect must come nearer."""
    u = np.sin(2 * np.pi * 1.3 * TIME)
    given = (record("run", u, 12.0 * u, ("V", "mm")),)
    sample = ScoredSamples.of(given)
    base, found = (
        ModelState((Gain(value=value),), given, sample) for value in (11.0, after)
    )
    model = Model("rig", *(Channel("in", "V"), Channel("out", "mm")), base.chain)
    inside = Inside(model, base, Named(found, ()), "")
    assert beats_base(inside, base, Floor(0.01, "declared")) == pays


def uneven(records, *offs):
    """A gain that is off by so much on each record, as its output is."""
    given = tuple(
        replace(x, y=x.u + off * np.sin(3 * TIME[: len(x)]))
        for x, off in zip(records, offs, strict=True)
    )
    return state_of((block("gain", value=1.0),), given)


def test_forces_that_leave_more_than_the_base_do_not_beat_it():
    """A score of logarithms falls far for one record that was nearly met before."""
    records = tuple(record(f"r{k}", np.sin((k + 1) * TIME), TIME) for k in range(2))
    base, state = uneven(records, 0.1, 0.1), uneven(records, 0.001, 0.3)
    model = Model("rig", *(Channel("in", "V"), Channel("out", "mm")), base.chain)
    floor = Floor(1e-6, "declared")
    score = Score.plain(base.sample, floor.square)
    assert score.of(state.residual) < score.of(base.residual) - 2 * CERTAIN
    assert not beats_base(Inside(model, base, Named(state, ()), ""), base, floor)
    better = uneven(records, 0.001, 0.1)
    assert beats_base(Inside(model, base, Named(better, ()), ""), base, floor)


@pytest.mark.parametrize(
    ("forces", "chain", "gain", "better"),
    [
        (1, 1, 41.0, True),
        (1, 1, 39.0, False),
        (1, 2, -59.0, True),
        (1, 2, -61.0, False),
        (1, 0, 41.0, True),
        (2, 0, 141.0, True),
        (2, 0, 139.0, False),
    ],
)
def test_what_a_chain_needs_more_counts_against_it(
    monkeypatch, forces, chain, gain, better
):
    """On folds forces have to gain 40, or 100 less for each further effect there.

    Where a chain has none they pay as effects in it do: the first 40, a further 100.
    """
    state = transfer((mass(30.0),))
    one = Added("friction", "inside", "", (), {}, 1.0)
    inside = Inside(None, state, Named(replace(state, added=(one,) * forces), ()), "")
    named = Named(replace(state, added=(one,) * chain), ())
    monkeypatch.setattr(
        "hystbench.gap.inside.named_inside.gain_on_folds",
        lambda _, found, *__: gain if found is inside.named.state else 0.0,
    )
    assert beats_chain(inside, named, FLOOR) == better


@pytest.mark.parametrize(
    ("chain", "forces", "form", "stands"),
    [
        (1, 2, "", False),
        (1, 1, "", True),
        (2, 2, "", True),
        (1, 2, "winding path", True),
    ],
)
def test_fewer_effects_of_a_chain_stand_where_they_leave_as_little(
    monkeypatch, chain, forces, form, stands
):
    """Forces gain on folds here, whatever they are. A path is no fewer effect."""
    state = transfer((mass(30.0),))
    named = "drift" if form else "eddy-diffusion"
    law = Added(named, "sensor", form, (), {}, 1.0)
    force = Added("friction", "inside", "", (), {}, 1.0)
    gap = SimpleNamespace(gap=lambda floor: 100 * state.power(floor))
    before = SimpleNamespace(before=gap)
    inside = Inside(None, state, Named(replace(state, added=(force,) * forces), ()), "")
    given = Named(replace(state, added=(law,) * chain), (before,))
    monkeypatch.setattr(
        "hystbench.gap.inside.named_inside.gain_on_folds",
        lambda _, found, *__: 1000.0 if found is inside.named.state else 0.0,
    )
    assert beats_chain(inside, given, FLOOR) == stands


def test_a_stop_on_both_sides_without_a_clearance_is_a_spring_and_no_stop():
    """A spring that is half as stiff again, beside a base that calls itself exact."""
    rng = np.random.default_rng(2)
    u = sum(30 * np.sin(2 * np.pi * f * TIME) for f in rng.uniform(0.3, 2.5, 8))
    _, y, _ = lsim(([1.0], [1.0, 2.0, 90.0]), u, TIME)
    given = (record("stiffer", u, y + 1e-4 * rng.standard_normal(len(y)), ("N", "m")),)
    base = Mechanism(mass=1.0, damping=2.0, stiffness=60.0, hold="linear")
    start = ModelState((base,), given, ScoredSamples.of(given)).settled()
    score = Score.plain(start.sample, 1e-8)
    host = Fitted(start, score.of(start.residual))
    every = search(host, score, offered=["stop"])
    assert {item.effects for item in every} == {()}


def test_a_rubber_stop_that_loses_energy_is_no_slider_with_gap():
    """Its force is steeper than a spring's, more on the way in, and never a pull."""

    def moves(t, state, u):
        q, v = state
        pressed = max(abs(q) - 0.3, 0.0) ** 1.3
        side = math.copysign(1.0, q)
        contact = 300.0 * pressed * max(1 + 0.3 * v * side, 0.0) * side
        return [v, np.interp(t, TIME, u) - 2.0 * v - 60.0 * q - contact]

    rng = np.random.default_rng(2)
    waves = [np.sin(2 * np.pi * f * TIME) for f in rng.uniform(0.3, 2.5, 8)]
    given = []
    for size in (5.0, 15.0):
        u = size * sum(waves)
        y = motion(moves, [0.0, 0.0], TIME, DT, u)
        y = y + 2e-3 * rng.standard_normal(len(y))
        given.append(record(f"run-{size:g}", u, y, ("N", "m")))
    base = Mechanism(mass=1.0, damping=2.0, stiffness=60.0, hold="linear")
    start = ModelState((base,), tuple(given), ScoredSamples.of(tuple(given))).settled()
    score = Score.plain(start.sample, 4e-6)
    rivals = ["stop", "slider-with-gap", "hysteretic-force", "stiffness-hardening"]
    host = Fitted(start, score.of(start.residual))
    _, *alone = each_alone(host, score, offered=rivals)
    best = min(alone, key=lambda item: item.score)
    assert best.effects == ("stop",)
    assert best.state.chain[1].loss == pytest.approx(0.3, rel=0.2)


@pytest.mark.parametrize("exact", [False, True])
def test_a_base_that_calls_itself_exact_is_not_fitted_as_a_host(exact):
    u = np.sin(2.1 * TIME)
    given = (record("run", u, u / 60.0, ("N", "m")),)
    base = Mechanism(mass=1.0, damping=2.0, stiffness=60.0)
    start = ModelState((base,), given, ScoredSamples.of(given))
    score = Score.plain(start.sample, NOISE**2)
    free = [len(x.fitted.state.free) for x in hosts(start, MOVES, False, score, exact)]
    assert free == ([0] if exact else [0, 3])


def test_a_host_of_a_given_base_is_fitted_about_what_is_stated():
    """A lag of one pole stands before the output: no mass, which would do as much."""
    rng = np.random.default_rng(3)
    u = sum(30 * np.sin(2 * np.pi * f * TIME) for f in rng.uniform(0.3, 2.5, 8))
    _, y, _ = lsim(([1.0], [0.5 * 0.2, 0.5 + 2.0 * 0.2, 2.0]), u, TIME)
    noise = 1e-3 * rng.standard_normal(len(y))
    given = (record("run", u, y + noise, ("N", "m")),)
    base = TransferFunction(numerator=(1.0,), denominator=(0.5, 2.0))
    start = ModelState((base,), given, ScoredSamples.of(given)).settled()
    score = Score.plain(start.sample, 1e-6)
    held, fitted = hosts(start, MOVES, False, score)
    mass = held.alone.chain[0].mass
    assert fitted.fitted.state.chain[0].mass == pytest.approx(mass, rel=0.1)
    moved = fitted.fitted.state.moved_charge
    assert 0.0 < moved < held.fitted.score - fitted.fitted.score


@pytest.mark.parametrize("identified", [False, True])
def test_the_zero_of_a_sensor_is_offered_behind_a_given_host(identified):
    """One that was identified from the records has an offset of its own."""
    u = np.sin(2.1 * TIME)
    given = (record("run", u, u / 60.0, ("N", "m")),)
    base = Mechanism(mass=1.0, damping=2.0, stiffness=60.0)
    state = ModelState((base,), given, ScoredSamples.of(given))
    times = Times.of(given, identified)
    offered = laws_for(Fitted(state, 0.0), times=times)
    forms = [law.form for law in offered.get("calibration-error", ())]
    assert forms == ([] if identified else ["gain", "offset", "gain and offset"])


def test_what_is_known_about_of_a_base_is_known_about_of_its_host():
    """A mass that the base does not have is not what a free pole becomes."""
    u = np.sin(2.1 * TIME) + np.sin(9.0 * TIME)
    _, y, _ = lsim(([1.0], [0.5, 2.0]), u, TIME)
    given = (record("run", u, y + 0.1 * u, ("N", "m")),)
    base = TransferFunction(numerator=(1.0,), denominator=(0.5, 2.0))
    free = (Free(0, "numerator", 0, 0.1, 0.9, 1.1, given=1.0),)
    start = ModelState((base,), given, ScoredSamples.of(given), free=free).settled()
    score = Score.plain(start.sample, 1e-6)
    (host,) = hosts(start, MOVES, False, score)
    assert all(item.given is not None for item in host.fitted.state.free)
