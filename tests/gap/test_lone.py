"""Power that stands in samples far off from the others."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.gap.records.disturbances import lone_share


@given(st.integers(0, 1000), st.floats(1e-6, 1e6))
def test_noise_and_sines_have_no_lone_samples(seed, size):
    noise = np.random.default_rng(seed).normal(size=2000)
    sine = np.sin(np.arange(2000) / 7)
    assert lone_share([size * noise, size * sine]) == 0.0


@given(st.integers(0, 1000), st.integers(1, 20))
def test_the_power_of_spikes_is_their_share(seed, count):
    rng = np.random.default_rng(seed)
    noise = rng.normal(size=4000)
    spikes = np.zeros(4000)
    spikes[rng.choice(4000, count, replace=False)] = 100.0
    power = count * 100.0**2
    expected = power / (power + noise @ noise)
    assert lone_share([noise + spikes]) == pytest.approx(expected, rel=0.1)


def test_a_residual_of_one_value_has_none():
    assert lone_share([np.zeros(10), np.full(10, 3.0)]) == 0.0
