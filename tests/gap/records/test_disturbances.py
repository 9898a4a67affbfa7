"""Power in lone samples, far off the others, and what differs between periods."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.gap.records.floor import unrepeated
from hystbench.gap.records.lone_samples import lone_share
from hystbench.gap.records.scored_samples import Compared
from hystbench.record import Channel, Record

PERIOD, DT = 100, 1e-3


@given(st.integers(0, 1000), st.floats(1e-6, 1e6))
def test_noise_and_sines_have_no_lone_samples(seed, size):
    noise = np.random.default_rng(seed).normal(size=2000)
    sine = np.sin(np.arange(2000) / 7)
    assert lone_share([compared(size * noise), compared(size * sine)]) == 0.0


@given(st.integers(0, 1000), st.integers(1, 20))
def test_the_power_of_spikes_is_their_share(seed, count):
    rng = np.random.default_rng(seed)
    noise = rng.normal(size=4000)
    spikes = np.zeros(4000)
    spikes[rng.choice(4000, count, replace=False)] = 100.0
    power = count * 100.0**2
    expected = power / (power + noise @ noise)
    assert lone_share([compared(noise + spikes)]) == pytest.approx(expected, rel=0.1)


def test_a_residual_of_one_value_has_none():
    residuals = np.zeros(10), np.full(10, 3.0)
    assert lone_share([compared(each, period=None) for each in residuals]) == 0.0


def compared(residual, period=PERIOD):
    """A record whose residual is this beside a model that says nothing."""
    u = np.sin(2 * np.pi * np.arange(len(residual)) / PERIOD)
    channels = (Channel("u", "V"), Channel("y", "um"))
    record = Record("record", DT, u, residual, *channels, "twin", period_samples=period)
    return Compared(record, np.zeros(len(residual)))


@given(st.integers(0, 1000), st.integers(3, 20), st.floats(0, 1e3))
def test_what_repeats_does_not_count(seed, periods, size):
    rng = np.random.default_rng(seed)
    shape = np.tile(size * rng.normal(size=PERIOD), periods)
    noise = rng.normal(size=PERIOD * periods)
    found = unrepeated([compared(shape + noise)], 1.0)
    assert found == pytest.approx(unrepeated([compared(noise)], 1.0), abs=1e-6)


@given(st.integers(0, 1000), st.floats(0.1, 10))
def test_a_level_that_jumps_between_periods_counts_by_its_variance(seed, size):
    rng = np.random.default_rng(seed)
    levels = rng.normal(size=12)
    residual = size * np.repeat(levels, PERIOD)
    noise = rng.normal(size=len(residual))
    found = unrepeated([compared(residual + noise)], 1.0)
    expected = size**2 * np.var(levels[1:], ddof=1)
    # The noise's own variance, and its product with the levels.
    spread = 6 * (1 + size) / np.sqrt(len(noise)) * (1 + abs(levels).max())
    assert found == pytest.approx(expected, abs=spread)


def test_the_first_period_may_settle():
    residual = np.zeros(5 * PERIOD)
    residual[:PERIOD] = 1.0
    assert unrepeated([compared(residual)], 0.1) == pytest.approx(-1.0)


def test_records_without_three_whole_periods_say_nothing():
    noise = np.random.default_rng(0).normal(size=3 * PERIOD - 1)
    assert unrepeated([compared(noise), compared(noise, None)], 1.0) is None
