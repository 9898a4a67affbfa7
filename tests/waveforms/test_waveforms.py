"""Waveforms against their formulas, and the lines and peaks that they promise."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.waveforms.chirp import Chirp
from hystbench.waveforms.random_sum_of_sines import RandomSumOfSines
from hystbench.waveforms.sine import Sine
from hystbench.waveforms.sum_of_sines import SumOfSines


def test_sine_by_hand():
    u = Sine.samples(frequency_hz=1, amplitude=2, duration_s=1, sampling_frequency_hz=4)
    np.testing.assert_allclose(u, [0, 2, 0, -2], atol=1e-15)


def test_chirp_has_the_frequency_that_the_paper_reads_off():
    # Section 4: about 63.4 Hz at 1.28 s and 69.7 Hz at 1.41 s.
    u = Chirp.samples(
        from_hz=1,
        to_hz=100,
        amplitude=1,
        duration_s=2.03,
        sampling_frequency_hz=100_000,
    )
    rising = np.flatnonzero((u[:-1] < 0) & (u[1:] >= 0)) / 100_000
    middle = (rising[1:] + rising[:-1]) / 2
    frequency = 1 / np.diff(rising)
    assert np.interp(1.28, middle, frequency) == pytest.approx(63.4, abs=0.1)
    assert np.interp(1.41, middle, frequency) == pytest.approx(69.7, abs=0.1)


def test_sum_of_sines_has_its_lines_and_no_others():
    u = SumOfSines.samples(
        frequencies_hz=[10, 30, 50],
        amplitudes=[0.1, 0.2, 0.3],
        gain=1.264,
        duration_s=1,
        sampling_frequency_hz=1000,
    )
    amplitude = 2 * np.abs(np.fft.rfft(u)) / len(u)
    np.testing.assert_allclose(
        amplitude[[10, 30, 50]], 1.264 * np.array([0.1, 0.2, 0.3]), rtol=1e-12
    )
    amplitude[[10, 30, 50]] = 0
    assert amplitude.max() < 1e-12


@given(seed=st.integers(0, 1000), sines=st.integers(2, 40), level=st.floats(0.1, 2))
def test_random_sum_stays_in_band_and_spans_its_level(seed, sines, level):
    u = RandomSumOfSines.samples(
        band=[0, 0.02],
        level=level,
        sines=sines,
        trials=3,
        seed=seed,
        gain=2,
        duration_s=2,
        sampling_frequency_hz=10_000,
    )
    assert u.max() == pytest.approx(2 * level, rel=1e-12)
    assert u.min() == pytest.approx(-2 * level, rel=1e-12)
    line = np.abs(np.fft.rfft(u)) / len(u)
    excited = np.flatnonzero(line > 1e-6 * line.max())
    excited = excited[excited > 0]
    assert len(excited) == sines
    # 0.02 of the Nyquist frequency of 5 kHz is 100 Hz, line 200 of a 2 s record.
    assert excited.max() == 200


def test_random_sum_keeps_the_draw_with_the_least_peak():
    arguments = {
        "band": [0, 0.02],
        "level": 1.0,
        "sines": 10,
        "seed": 3,
        "gain": 1,
        "duration_s": 2,
        "sampling_frequency_hz": 10_000,
    }
    one = RandomSumOfSines.samples(trials=1, **arguments)
    ten = RandomSumOfSines.samples(trials=10, **arguments)
    # At equal peaks the draw with the smaller crest has the larger rms.
    assert ten.std() >= one.std()


@pytest.mark.parametrize(("count", "highest"), [(40, 1.0), (41, 1.0), (200, 0.1)])
def test_random_sum_is_the_sum_of_its_sines(count, highest):
    """One draw, added up sine by sine; the highest line may be Nyquist's own."""
    u = RandomSumOfSines.samples(
        band=(0.0, highest),
        level=0.5,
        sines=5,
        trials=1,
        seed=4,
        gain=1.0,
        duration_s=count / 100,
        sampling_frequency_hz=100.0,
    )
    top = int(highest * count / 2)
    lines = top - (top // 5) * np.arange(5)[::-1]
    phases = np.random.default_rng(4).uniform(0, 2 * np.pi, 5)
    n = np.arange(count)
    total = sum(
        np.cos(2 * np.pi * line * n / count + phase)
        for line, phase in zip(lines, phases, strict=True)
    )
    middle = (total.max() + total.min()) / 2
    expected = 0.5 * (total - middle) / (np.ptp(total) / 2)
    np.testing.assert_allclose(u, expected, atol=1e-12)
