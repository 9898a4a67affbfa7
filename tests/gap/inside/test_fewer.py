"""Forces put into a mass, and a search on fewer samples of its records."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.blocks import registry
from hystbench.blocks.friction_force import FrictionForce
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.sensor_lag import SensorLag
from hystbench.blocks.stiffness import Stiffness
from hystbench.gap.effects.law import Law
from hystbench.gap.fitting.least_squares import Fitted
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.inside.average_force import evened
from hystbench.gap.inside.fewer import OnAll, on_fewer
from hystbench.gap.inside.insert_law import with_law
from hystbench.gap.records.coarser import ENOUGH
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.simulation.starting import starting
from hystbench.gap.thresholds import PAYS, SCALE
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record

MACHINE = Mechanism(mass=2.0, damping=6.0, stiffness=800.0)
DT, COUNT = 1e-3, 4 * ENOUGH
MOVED = Quantities("force", "position")


def state(record, chain=(MACHINE,)):
    records = (record,)
    return ModelState(chain, records, ScoredSamples.of(records))


def free(record, machine=MACHINE):
    numbers = Free(0, "stiffness"), Free(0, "damping")
    return replace(state(record, (machine,)), free=numbers)


def periodic(start, periods=2):
    """A steady motion, or one from rest: a multisine of up to 10 Hz."""
    t = np.arange(COUNT) * DT
    tones = np.arange(1, 80)
    angles = 2 * np.pi * np.outer(t, tones) / (COUNT * DT) + tones**2
    u = np.tile(np.cos(angles).sum(axis=1), periods)
    y = replace(MACHINE, start=start).simulate(u, u, DT)
    channels = Channel("force", "N"), Channel("position", "m")
    return Record("r", DT, u, y, *channels, "measured", period_samples=COUNT)


def test_a_cubic_spring_on_a_sine_begins_as_its_describing_function():
    """The mean of q^3 over a sine of amplitude a is 3/4 a^2 q."""
    w, a = 30.0, 0.02
    t = np.arange(20000) * DT
    drive = abs(-2.0 * w**2 + 20j * w + 800.0) * a * np.sin(w * t)
    channels = Channel("force", "N"), Channel("position", "m")
    record = Record("r", DT, drive, drive, *channels, "measured")
    machine = replace(MACHINE, damping=20.0)  # soon in a steady motion
    law = Law("cubic", Stiffness(quadratic=0.0, cubic=1e5), ("cubic",))
    begun = evened(with_law(free(record, machine), "stiffness-hardening", law))
    out = 800.0 - begun.chain[0].stiffness
    assert out == pytest.approx(0.75 * a**2 * 1e5, rel=0.03)
    assert begun.chain[0].damping == pytest.approx(20.0, rel=0.05)


def test_only_a_number_that_is_free_is_evened():
    law = Law("cubic", Stiffness(quadratic=0.0, cubic=1e5), ("cubic",))
    host = replace(state(periodic("rest", 1)), free=(Free(0, "damping"),))
    begun = evened(with_law(host, "stiffness-hardening", law)).chain[0]
    assert begun.stiffness == MACHINE.stiffness


def test_a_friction_takes_no_more_than_there_is():
    record = periodic("rest", 1)
    law = Law("dry", FrictionForce(coulomb=1e5, presliding_distance=1e-6), ("coulomb",))
    begun = evened(with_law(free(record), "friction", law))
    assert 0.0 < begun.chain[0].damping < 0.1 * MACHINE.damping


KNOWN_ABOUT = (Free(0, "stiffness", tolerance=80.0, given=800.0), Free(0, "blend"))


@pytest.mark.parametrize("numbers", [(), KNOWN_ABOUT])
def test_a_host_that_is_known_stays_as_it_is(numbers):
    record = periodic("rest", 1)
    law = Law("cubic", Stiffness(quadratic=0.0, cubic=1e5), ("cubic",))
    host = replace(state(record), free=numbers)
    begun = evened(with_law(host, "stiffness-hardening", law))
    assert begun.chain[0] == MACHINE


@pytest.mark.parametrize("start", ["rest", "repeating"])
def test_what_is_found_on_fewer_samples_starts_as_all_of_them_do(start):
    whole = state(periodic(start), (replace(MACHINE, start=start),))
    fewer = on_fewer(whole, MOVED)
    assert len(fewer.records[0]) == ENOUGH
    assert fewer.chain[0].start == "repeating"
    if start == "repeating":
        assert np.abs(fewer.residual).max() < 1e-3 * np.ptp(whole.measured)
    score = Score.plain(whole.sample, 1e-12)
    on_all = OnAll.of(whole, score, fewer, True)
    assert on_all.start == start
    back = on_all.state(fewer)
    assert back.records == whole.records
    np.testing.assert_allclose(back.residual, whole.residual, atol=1e-9)


def test_a_force_that_a_motion_makes_keeps_all_samples():
    whole = state(periodic("rest"))
    moved = Quantities("position", "force")
    assert on_fewer(whole, moved) is whole


def test_rivals_of_what_was_chosen_are_fitted_to_all_samples_too():
    """A lag behind linear dynamics is one before them: both have to be fitted."""
    record = periodic("rest", 1)
    shown = replace(
        record, y=SensorLag(time_constant_s=0.004).simulate(record.y, record.u, DT)
    )
    whole = state(shown)
    score = Score.plain(whole.sample, 1e-12)
    found = [Fitted(whole, 100.0)]
    for effect, place, value in (
        ("sensor-lag", "behind", 0.0041),
        ("drive-lag", "before", 0.0042),
        ("drive-lag", "before", 0.02),
    ):
        block = registry()[effect].from_mapping({"time_constant_s": value})
        law = Law("", block, ("time_constant_s",), place)
        score_on_fewer = 0.0 if value < 0.01 else 2 * PAYS
        found.append(Fitted(with_law(whole, effect, law), score_on_fewer))
    on_all = OnAll(whole, score, "rest")
    _, best, rival, other = on_all.hypotheses(found, found[:2])
    assert abs(best.score - rival.score) < SCALE
    assert other.score > best.score + PAYS


def test_a_lag_that_repeats_is_settled_where_the_dynamics_begin_at_rest():
    lag = SensorLag(time_constant_s=0.01, start="repeating")
    at_rest, host = starting((lag, replace(MACHINE, start="repeating")), "rest")
    assert (at_rest.start, host.start) == ("settled", "rest")
    assert starting((replace(lag, start="rest"),), "rest")[0].start == "rest"
