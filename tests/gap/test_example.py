"""The worked example's dataset: its periods are read off the input."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.dataset import load_dataset
from hystbench.gap.example import whole_period, write_example
from hystbench.record import Channel, Record

CURRENT, LENGTH = Channel("current", "A"), Channel("displacement", "um")


@given(period=st.integers(4, 60), count=st.integers(2, 9), seed=st.integers(0, 99))
def test_a_signal_that_is_repeated_has_the_period_it_was_made_of(period, count, seed):
    # One of period's own lines is sure, so that no shorter period is hidden in it.
    once = np.sin(2 * np.pi * np.arange(period) / period)
    once += 0.1 * np.random.default_rng(seed).normal(size=period)

    assert whole_period(np.tile(once, count)) == period


@pytest.mark.parametrize(
    ("frequency_hz", "expected"), [(10.0, 100), (60.0, 50), (150.0, 20), (0.7, None)]
)
def test_of_sines_the_shortest_stretch_of_whole_samples_and_periods(
    frequency_hz, expected
):
    time = np.arange(2000) / 1000
    noise = 1e-4 * np.random.default_rng(0).normal(size=2000)

    assert whole_period(np.sin(2 * np.pi * frequency_hz * time) + noise) == expected


def test_the_dataset_names_the_period_of_records_that_have_one(tmp_path):
    time = np.arange(2000) / 1000
    sine = np.sin(2 * np.pi * 10 * time)
    chirp = np.sin(2 * np.pi * (1 + 5 * time) * time)
    records = [
        Record(name, 1e-3, u, 2 * u, CURRENT, LENGTH, "twin")
        for name, u in (("sine", sine), ("chirp", chirp))
    ]
    identified = {
        "envelope": [1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0],
        "thresholds": [0.0],
        "weights": [2.0],
        "start": "rest",
        "offset": 0.0,
    }
    write_example(records[:1], records[1:], identified, tmp_path)

    dataset = load_dataset(tmp_path / "dataset")
    assert dataset.read("sine").period_samples == 100
    assert (dataset.use("sine"), dataset.use("chirp")) == ("fit", "hold-out")
    assert dataset.read("chirp").period_samples is None
