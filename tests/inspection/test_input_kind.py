"""Kinds of input on signals that are made, of several lengths, seeds and noises."""

import numpy as np
import pytest
from scipy import signal

from hystbench.inspection.input_kind import kind_of_input

SEEDS = range(6)
CORNER = 6.0
"""Frequency from which a filter takes the harmonics of a triangle, over its own."""


def sine(rng, t):
    return np.sin(2 * np.pi * rng.uniform(3, 40) * t + rng.uniform(0, 6))


def few_sines(rng, t):
    hz = 3 + np.cumsum(rng.uniform(3, 10, rng.integers(2, 10)))
    phases, sizes = rng.uniform(0, 6, len(hz)), rng.uniform(0.3, 1, len(hz))
    return np.sin(2 * np.pi * np.outer(t, hz) + phases) @ sizes


def many_sines_four_times(rng, t):
    """Of so many lines none is counted, but all of them come back."""
    hz = 4.0 * np.arange(1, 60)
    return np.sin(2 * np.pi * np.outer(t, hz) + rng.uniform(0, 6, len(hz))).sum(1)


def below(hz, u, order=4):
    """Pass what is below a frequency, in periods of the record."""
    low = signal.butter(order, 2 * hz / len(u), output="sos")
    return signal.sosfilt(low, u)


def noise(rng, t):
    twice = rng.standard_normal(2 * len(t))
    return below(2 * rng.uniform(30, len(t) / 5), twice)[len(t) :]


def slow_noise(rng, t):
    """A few dozen lines of the spectrum have all of its power."""
    return below(2 * rng.uniform(8, 30), rng.standard_normal(2 * len(t)))[len(t) :]


def noise_of_a_band(rng, t):
    middle = rng.uniform(30, 100)
    edges = np.array([0.8, 1.25]) * 2 * middle / len(t)
    band = signal.butter(3, edges, "bandpass", output="sos")
    return signal.sosfilt(band, rng.standard_normal(2 * len(t)))[len(t) :]


def sweep(rng, t):
    first = rng.uniform(4, 10)
    method = rng.choice(["linear", "logarithmic"])
    last = first * rng.uniform(3, 12)
    swept = signal.chirp(t, first, 1, last, method, rng.uniform(0, 360))
    return swept * (0.5 + t)


def short_sweep_down(rng, t):
    first = rng.uniform(10, 30)
    return signal.chirp(t, first * rng.uniform(1.7, 2.5), 1, first)


def rounded(u, periods):
    low = signal.butter(2, 2 * CORNER * periods / len(u), output="sos")
    return signal.sosfiltfilt(low, u)


def triangle(rng, t):
    periods = rng.uniform(4, 30)
    return rounded(signal.sawtooth(2 * np.pi * periods * t + 1, 0.5), periods)


def growing_triangle(rng, t):
    """Two periods of each of ten amplitudes, at any of some times from zero on."""
    angle = 2 * np.pi * (20 * t + rng.uniform(0, 1))
    size = np.ceil(10 * np.maximum(t, 1e-9)) / 10
    return rounded(size * signal.sawtooth(angle, 0.5), 20)


EXPECTED = [
    (sine, "sine"),
    (few_sines, "sum of sines"),
    (many_sines_four_times, "sum of sines"),
    (noise, "broadband"),
    (slow_noise, "broadband"),
    (noise_of_a_band, "broadband"),
    (sweep, "sweep"),
    (short_sweep_down, "sweep"),
    (triangle, "ramps"),
    (growing_triangle, "ramps"),
]


@pytest.mark.parametrize("share", [0.0, 0.01, 0.03], ids="noise-{}".format)
@pytest.mark.parametrize("count", [1000, 3000])
@pytest.mark.parametrize(
    ("make", "kind"), EXPECTED, ids=lambda x: getattr(x, "__name__", "")
)
def test_a_signal_is_of_its_kind(make, kind, count, share):
    found = []
    for seed in SEEDS:
        rng = np.random.default_rng(seed)
        u = make(rng, np.arange(count) / count)
        found.append(kind_of_input(u + share * u.std() * rng.standard_normal(count)))
    assert found == [kind] * len(SEEDS)
