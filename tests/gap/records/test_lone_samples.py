"""Lone samples of a residual, far off their neighbours."""

import numpy as np

from hystbench.gap.records.lone_samples import far_off


def test_noise_that_grows_with_the_motion_is_not_lone_and_a_spike_in_it_is():
    random, time = np.random.default_rng(8), np.linspace(0, 1, 4000)
    swell = 1 + 30 * np.exp(-(((time - 0.5) / 0.03) ** 2))
    noise = swell * random.standard_normal(len(time))
    assert not far_off(noise).any()
    noise[1900] += 60 * swell[1900]
    assert np.flatnonzero(far_off(noise)).tolist() == [1900]
