"""Linear effects of a device that was in operation before its records began."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.gap.effects import effects
from hystbench.gap.naming.rank import rank
from hystbench.gap.simulation.simulation import Simulation
from tests.gap.made import record
from tests.gap.small import block, plain_score, state_of

TAU, DT, COUNT = 0.4, 0.01, 1000
NOISE = 0.002


def operated(middle, whole=True):
    """Two records of a lag of .4 s that has run long before, about a middle."""
    rng = np.random.default_rng(2)
    made = []
    for k in range(2):
        t = DT * np.arange(5 * COUNT)
        u = middle + np.sin(2 * np.pi * 0.3 * t + k) + 0.5 * np.sin(2 * np.pi * 1.1 * t)
        y = np.full(len(u), middle)
        for n in range(1, len(u)):  # exact for straight lines, nearly
            y[n] = y[n - 1] + (1 - np.exp(-DT / TAU)) * (
                u[n - 1 : n + 1].mean() - y[n - 1]
            )
        own = record(
            u[-COUNT:],
            2.0 * y[-COUNT:] + NOISE * rng.standard_normal(COUNT),
            name=f"run-{k}",
            dt=DT,
        )
        made.append(replace(own, period_samples=COUNT if whole else None))
    return tuple(made)


BASE = (block("gain", value=2.0, offset=0.0),)


@pytest.mark.parametrize(("whole", "start"), [(True, "repeating"), (False, "settled")])
def test_a_lag_is_tried_from_where_it_operates(whole, start):
    state = state_of(BASE, operated(6.0, whole))
    lags = [effects()[name] for name in ("sensor-lag", "creep", "drift")]
    first = rank(state, plain_score(state, NOISE**2), lags, folds=False)[0]
    assert first.effect == "sensor-lag"
    (lag,) = (x for x in first.state.chain if x.name == "sensor-lag")
    assert lag.start == start
    assert lag.time_constant_s == pytest.approx(TAU, rel=0.1)


def test_an_input_that_comes_to_zero_may_begin_at_rest():
    state = state_of(BASE, operated(0.0))
    tried = list(effects()["sensor-lag"].every_variant(state.simulation))
    assert {item.operates for item in tried} == {""}


def test_a_device_may_have_been_switched_on_with_its_record():
    state = state_of(BASE, operated(6.0))
    tried = list(effects()["drive-lag"].every_variant(state.simulation))
    assert {item.operates for item in tried} == {"", "repeating"}


@pytest.mark.parametrize("start", ["settled", "moving", "repeating"])
def test_what_is_put_in_a_chain_begins_as_the_chain_does(start):
    """A lag that began at rest would answer the first samples in its own way."""
    dynamics = block(
        "transfer-function", numerator=[1.0], denominator=[0.05, 1.0], start=start
    )
    state = state_of((*BASE, dynamics), operated(0.0))
    for name in ("sensor-lag", "creep", "resonance"):
        tried = list(effects()[name].every_variant(state.simulation))
        assert {item.operates for item in tried if item.is_linear} == {start}


def test_on_a_record_that_does_not_repeat_its_first_value_has_stood_before():
    """What was found on whole periods is shown on a step that was held out."""
    chain = (block("sensor-lag", time_constant_s=TAU, start="repeating"),)
    step = record(np.where(np.arange(COUNT) < 100, 5.0, 7.0), np.zeros(COUNT), dt=DT)
    (whole,) = Simulation(chain, (replace(step, period_samples=COUNT),)).output
    (once,) = Simulation(chain, (replace(step, period_samples=None),)).output
    assert whole[0] > 6.5  # it comes from the end of the period before
    np.testing.assert_allclose(once[:100], 5.0, atol=1e-12)


def test_a_device_that_was_idle_may_answer_late():
    """A first input of ten from the first sample on reaches a lag seven seconds later.

    If the delayed input had been there before, the lag would rise at once.
    """
    rng, dt = np.random.default_rng(3), 0.5
    steps = np.repeat(rng.uniform(5, 15, 20), 60)
    t = dt * np.arange(len(steps))
    lag = block("sensor-lag", time_constant_s=40.0, hold="zero-order")
    late = np.concatenate([np.zeros(14), steps[:-14]])
    y = lag.simulate(late, late, dt) + 0.05 * rng.standard_normal(len(t))
    state = state_of((lag,), (record(steps, y, name="heater", dt=dt),))
    known = [effects()[name] for name in ("input-delay", "drive-lag", "sensor-lag")]
    first = rank(state, plain_score(state, 0.05**2), known, folds=False)[0]
    assert (first.effect, first.form) == ("input-delay", "idle before")
    (delay,) = (x for x in first.state.chain if x.name == "input-delay")
    assert delay.start == "rest"
    assert delay.delay_s == pytest.approx(7.0, abs=0.3)
