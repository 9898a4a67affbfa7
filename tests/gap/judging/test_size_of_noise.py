"""Noise of one size, and what is larger where a device moves more."""

import numpy as np
import pytest
from scipy.signal import lfilter

from hystbench.gap.fitting.state import ModelState
from hystbench.gap.judging.leftover import size_follows
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.record import Channel, Record
from tests.gap.small import block

ABOUT = Channel("current", "A"), Channel("displacement", "um"), "twin"
DT, COUNT = 1e-3, 4000
TIME = np.arange(COUNT) * DT


def state_beside(noise_of):
    """Three sines of a gain, and noise that is made beside what it gives."""
    records = []
    for k, frequency in enumerate((3.0, 7.0, 11.0)):
        rng = np.random.default_rng(k)
        u = (0.3 + 0.2 * k) * np.sin(2 * np.pi * frequency * TIME)
        y = 12.0 * u
        records.append(Record(f"r{k}", DT, u, y + noise_of(y, rng), *ABOUT))
    found = tuple(records)
    return ModelState((block("gain", value=12.0),), found, ScoredSamples.of(found))


def white(y, rng):
    return 0.1 * rng.standard_normal(len(y))


def coloured(y, rng):
    """Of first order, that remembers fifty samples."""
    return 0.02 * lfilter([1.0], [1.0, -0.98], rng.standard_normal(len(y)))


def multiplied(y, rng):
    return 0.05 * y * rng.standard_normal(len(y)) + white(y, rng) / 3


def pumped(y, rng):
    """The gain is modulated by what runs on a clock of its own."""
    return 0.1 * y * np.sin(2 * np.pi * 61.3 * TIME + rng.uniform(0, 6))


@pytest.mark.parametrize("noise_of", [white, coloured])
def test_noise_of_one_size_follows_nothing(noise_of):
    assert not size_follows(state_beside(noise_of))


@pytest.mark.parametrize("noise_of", [multiplied, pumped])
def test_what_is_larger_where_more_moves_is_no_noise(noise_of):
    assert size_follows(state_beside(noise_of))


def test_nothing_left_follows_nothing():
    assert not size_follows(state_beside(lambda y, rng: np.zeros_like(y)))
