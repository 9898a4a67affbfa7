"""A lag beside an identified host is a pole of the base, and no effect."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.blocks.attached import attached
from hystbench.blocks.drag import Drag
from hystbench.blocks.friction_force import FrictionForce
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.sensor_lag import SensorLag
from hystbench.gap.effects.law import Law
from hystbench.gap.fitting.least_squares import fitted_to_the_end
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.inside.insert_law import with_law
from hystbench.gap.inside.lags_of_base import with_lags_of_base
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.record import Channel, Record

MACHINE = Mechanism(mass=2.0, damping=6.0, stiffness=800.0)
LAG_S, COULOMB, NOISE = 0.02, 8.0, 2e-5
DT, COUNT = 5e-3, 1200
FRICTION = FrictionForce(coulomb=COULOMB, presliding_distance=1e-4)


@pytest.fixture(scope="module")
def record():
    t = np.arange(COUNT) * DT
    u = 30 * np.sin(9 * t) + 25 * np.sin(23 * t + 1) * np.sin(t)
    y = u
    for step in attached([MACHINE, FRICTION, SensorLag(time_constant_s=LAG_S)]):
        y = step.simulate(y, u, DT)
    y = y + NOISE * np.random.default_rng(4).standard_normal(COUNT)
    channels = Channel("force", "N"), Channel("position", "m")
    return Record("r", DT, u, y, *channels, "measured")


@pytest.fixture(scope="module")
def found(record):
    """The host, with friction, and with friction and a lag; scores of all of them."""
    numbers = tuple(Free(0, name) for name in ("mass", "damping", "stiffness"))
    sample = ScoredSamples.of((record,))
    host = ModelState((MACHINE,), (record,), sample, free=numbers)
    score = Score.plain(sample, NOISE**2)
    friction = Law("dry", replace(FRICTION, coulomb=4.0), ("coulomb",))
    lag = SensorLag(time_constant_s=0.01)
    late = Law("", lag, ("time_constant_s",), "behind")
    rubbed = with_law(host, "friction", friction)
    both = with_law(rubbed, "sensor-lag", late)
    pulled = with_law(host, "drag", Law("", Drag(coefficient=1.0), ("coefficient",)))
    other = with_law(pulled, "sensor-lag", late)
    tried = (host, rubbed, both, pulled, other)
    return [fitted_to_the_end(x, score) for x in tried], score


def test_the_host_has_the_lag_and_the_effects_are_what_is_left(found):
    tried, score = found
    alone, best, rival = with_lags_of_base(tried[2], tried, score)
    assert (alone.effects, best.effects) == ((), ("friction",))
    # What rivals it is what was found beside a lag, as it was.
    assert rival.effects == ("drag",)
    np.testing.assert_array_equal(rival.state.residual, tried[4].state.residual)
    lags = [
        x for item in (alone, best) for x in item.state.chain if x.name == "sensor-lag"
    ]
    assert len(lags) == 2
    assert lags[1].time_constant_s == pytest.approx(LAG_S, rel=0.02)
    (rub,) = (x for x in best.state.chain if isinstance(x, FrictionForce))
    assert rub.coulomb == pytest.approx(COULOMB, rel=0.02)
    # It does what it did, and one number less is charged.
    np.testing.assert_array_equal(best.state.residual, tried[2].state.residual)
    assert best.state.freedom == tried[2].state.freedom - 1
    assert best.score < tried[1].score


def test_without_a_lag_all_stays(found):
    tried, score = found
    kept = with_lags_of_base(tried[1], tried, score)
    assert all(a is b for a, b in zip(kept, tried, strict=True))
