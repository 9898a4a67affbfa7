"""Periods that are known beforehand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.periods import find_period, repeats

K = np.arange(4000)
RNG = np.random.default_rng(3)
ROUND = RNG.standard_normal(500)
ROUNDED = RNG.uniform(-1, 1, 4000)
TRIANGLE = np.abs((K + 100) % 400 - 200.0) / 100 - 1
FADED = np.minimum(K / 150, 1.0) * TRIANGLE


@pytest.mark.parametrize(
    ("u", "period"),
    [
        (np.sin(2 * np.pi * K / 200), 200),
        (3 + np.sin(2 * np.pi * K / 200), 200),
        (np.sin(2 * np.pi * K / 200) + 0.02 * RNG.standard_normal(4000), 200),
        (np.sin(2 * np.pi * K / 200) + np.sin(2 * np.pi * K / 300), 600),
        (np.tile(ROUND, 8), 500),
        (np.abs(K % 500 - 250.0), 500),
        (1.0 * (K % 400 < 100), 400),
        # Ten periods of 100.3 samples are 1003; three are 300.9.
        (np.sin(2 * np.pi * K / 100.3), 1003),
        (FADED, 400),
        (FADED + 0.01 * RNG.standard_normal(4000), 400),
    ],
)
def test_a_period_is_found(u, period):
    assert find_period(u) == period


@pytest.mark.parametrize(
    "u",
    [
        1.0 * K,
        np.zeros(4000),
        RNG.standard_normal(4000),
        np.cumsum(RNG.standard_normal(4000)),
        np.sin(2 * np.pi * (K / 400) ** 2),
        np.sin(2 * np.pi * K / 3000),  # once and a third
        1.0 * (K > 2000),
        K / 4000 * np.sin(2 * np.pi * K / 125),  # grows
        # Three sines that nearly come back after 2000 samples, but not quite.
        sum(np.sin(2 * np.pi * K * n / 2000) for n in (3.01, 7.02, 11.015)),
        np.exp(-K / 8000) * np.sin(2 * np.pi * K / 125) + 1e-3 * ROUNDED,
        # A period of 17.86 samples; seven of them do not lie twice in it.
        np.sin(2 * np.pi * K[:200] / 17.86) + 1e-3 * ROUNDED[:200],
    ],
)
def test_what_does_not_repeat_itself_has_none(u):
    assert find_period(u) is None


def test_nothing_contradicts_a_period_that_the_record_holds_once():
    assert repeats(ROUND, len(ROUND))
    assert repeats(np.tile(ROUND, 2)[:700], len(ROUND))


@given(period=st.integers(4, 60), count=st.integers(2, 9), seed=st.integers(0, 99))
def test_a_signal_that_is_repeated_has_the_period_it_was_made_of(period, count, seed):
    # One of period's own lines is sure, so that no shorter period is hidden in it.
    once = np.sin(2 * np.pi * np.arange(period) / period)
    once += 0.1 * np.random.default_rng(seed).normal(size=period)

    assert find_period(np.tile(once, count)) == period


@pytest.mark.parametrize(
    ("frequency_hz", "expected"), [(10.0, 100), (60.0, 50), (150.0, 20), (0.7, None)]
)
def test_of_sines_the_shortest_stretch_of_whole_samples_and_periods(
    frequency_hz, expected
):
    time = np.arange(2000) / 1000
    noise = 1e-4 * np.random.default_rng(0).normal(size=2000)

    assert find_period(np.sin(2 * np.pi * frequency_hz * time) + noise) == expected


@pytest.mark.parametrize("corner", [1, 4, 16])
def test_noise_that_is_smooth_itself_hides_no_period_of_a_slower_input(corner):
    white = np.random.default_rng(1).standard_normal(4000)
    noise = np.convolve(white, np.hanning(2 * corner + 1), "same")
    u = sum(np.sin(2 * np.pi * K * n / 1000 + n) for n in (1, 3, 8))
    assert find_period(u + 0.03 * noise / noise.std()) == 1000


@pytest.mark.parametrize("samples", [8, 20, 50])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_noise_that_is_slower_than_the_input_hides_no_period(samples, seed):
    white = np.random.default_rng(seed).standard_normal(4200)
    noise = np.convolve(white, np.hanning(33), "same")[100:4100]
    sine = np.sin(2 * np.pi * K / samples)
    period = find_period(sine + 0.02 * np.std(sine) * noise / noise.std())
    # Over one period such noise is a slope: a multiple may differ by it more clearly.
    assert period in [samples * count for count in (1, 2, 3, 4, 5)]


@pytest.mark.parametrize("lines", [2, 3, 5, 10])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_of_lines_that_nearly_come_back_there_is_no_period(lines, seed):
    # After 700 samples each is off by up to a hundredth of its own period.
    rng = np.random.default_rng(seed)
    off = rng.choice([-0.01, 0.01], lines)
    off[0], off[1] = 0.01, -0.01
    times = rng.choice(np.arange(1, 30), lines, replace=False) + off
    u = sum(np.sin(2 * np.pi * K * n / 700 + i * i) for i, n in enumerate(times))
    assert find_period(u) is None


def test_noise_of_the_measurement_hides_no_period_of_many_lines():
    measured = np.tile(ROUND, 2)
    measured += 0.01 * np.random.default_rng(5).standard_normal(len(measured))
    assert find_period(measured) == len(ROUND)
