"""The noise floor against noise of a known level."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.gap.records.floor import noise_floor
from tests.gap.examples import DT, compare, inputs, linear, mode

SEEDS = st.integers(0, 2**32 - 1)
LEVELS = st.floats(1e-6, 1e3)


def records(seed, level, disturb, repeats=True):
    """A gain with a resonance as its gap, and white noise of a level times it."""
    rng = np.random.default_rng(seed)
    found = []
    for name, u, period in inputs(4000, seed):
        t = np.arange(len(u)) * DT
        y = linear(6 * u, mode(70, 0.05, 0.1)) + 0.1 * rng.standard_normal(len(u))
        y += disturb * (3 * t + np.sin(2 * np.pi * 50.3 * t + rng.uniform(0, 6)))
        kept = period if repeats and period and period <= len(u) // 2 else None
        found.append(compare(name, u, level * y, level * 6 * u, kept))
    return found


@given(SEEDS, LEVELS, st.sampled_from([0.0, 0.5]))
def test_repeats_give_the_noise_beside_gap_drift_and_mains(seed, level, disturb):
    floor = noise_floor(records(seed, level, disturb))
    assert floor.method == "repeats"
    # About a thousand bins a record: a few per cent, a median of a few of them less.
    assert floor.rms == pytest.approx(0.1 * level, rel=0.1)


def test_spikes_and_dropouts_among_the_repeats_are_no_noise():
    found = []
    for item in records(1, 1.0, 0.0):
        y = item.record.y.copy()
        y[[210, 211, 900]] += 300.0, -200.0, 40.0
        found.append(replace(item, record=replace(item.record, y=y)))
    floor = noise_floor(found)
    assert floor.method == "repeats"
    assert floor.rms == pytest.approx(0.1, rel=0.1)


@given(SEEDS, LEVELS)
def test_without_repeats_the_high_band_gives_a_bound_near_the_noise(seed, level):
    floor = noise_floor(records(seed, level, 0.5, repeats=False))
    assert floor.method == "upper-bound"
    assert 0.09 * level < floor.rms < 0.15 * level


def test_a_gap_up_to_the_highest_frequency_makes_the_bound_larger_not_smaller():
    rng = np.random.default_rng(0)
    u = rng.standard_normal(4000)
    noise = 0.01 * rng.standard_normal(4000)
    floor = noise_floor([compare("noise", u, 6 * u + u**2 + noise, 6 * u)])
    # A square of the input is predicted, and is no noise.
    assert floor.rms < 2 * np.std(noise)
    assert floor.method == "upper-bound"
    assert floor.rms > 0.01


def test_a_declared_floor_is_taken_as_it_is():
    floor = noise_floor(records(1, 1.0, 0.0), declared=0.25)
    assert (floor.rms, floor.method) == (0.25, "declared")


def test_no_noise_gives_a_tiny_floor_above_zero():
    for name, u, period in inputs(4000):
        floor = noise_floor([compare(name, u, 6 * u, 6 * u, period)])
        assert 0 < floor.rms < 1e-3


@given(st.floats(0.01, 1.0))
def test_quantisation_is_a_floor_even_where_every_period_is_the_same(step):
    u = np.sin(2 * np.pi * np.arange(4000) / 400)
    y = step * np.round(6 * u / step)
    floor = noise_floor([compare("sine", u, y, 6 * u, 400)])
    assert floor.rms == pytest.approx(step / np.sqrt(12), rel=1e-6)


def test_records_of_other_rates_and_lengths_and_one_without_repeats():
    rng = np.random.default_rng(3)
    found = []
    for i, (n, dt, period) in enumerate(
        [(4000, DT, 400), (900, 4 * DT, 300), (3000, DT, None)]
    ):
        u = np.sin(2 * np.pi * np.arange(n) / (period or 300))
        y = 6 * u + 0.2 * rng.standard_normal(n)
        found.append(compare(f"r{i}", u, y, 6 * u, period, dt))
    floor = noise_floor(found)
    assert floor.method == "repeats"
    assert floor.rms == pytest.approx(0.2, rel=0.25)


def test_coloured_noise_gives_a_finite_floor():
    rng = np.random.default_rng(4)
    u = np.sin(2 * np.pi * np.arange(4000) / 400)
    noise = np.convolve(rng.standard_normal(4000), np.ones(20) / 20, mode="same")
    for period in (400, None):
        floor = noise_floor([compare("sine", u, 6 * u + noise, 6 * u, period)])
        assert 0 < floor.rms < 2 * np.std(noise)
