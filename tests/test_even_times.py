"""Samples of an uneven clock, put on even times."""

import numpy as np
import pytest

from hystbench.errors import InputError
from hystbench.even_times import on_even_times, usual_step

NONE_LOST = np.zeros(6, bool)


def test_straight_lines_stay_straight_and_a_staircase_stays_one():
    time = np.array([0.0, 1.1, 1.9, 3.2, 4.0, 5.0])
    signals = {"input": np.array([1.0, 1, 2, 2, 3, 3]), "output": 2 * time + 1}
    even = on_even_times("r", time, 1.0, signals, NONE_LOST, "zero-order")
    np.testing.assert_allclose(even.signals["output"], 2 * np.arange(6) + 1)
    # At 1.0 s the step at 1.9 s is to come; at 2.0 s it is over.
    assert even.signals["input"].tolist() == [1, 1, 2, 2, 3, 3]
    assert not even.lost.any()
    lines = on_even_times("r", time, 1.0, signals, NONE_LOST, "linear")
    assert lines.signals["input"][2] == pytest.approx(2.0)
    assert lines.signals["input"][1] == pytest.approx(1.0)


def test_what_lies_in_a_gap_or_beside_a_missing_sample_was_not_measured():
    time = np.array([0.0, 1.0, 2.0, 6.0, 7.0, 8.0])
    signals = {"input": time, "output": time}
    missing = NONE_LOST.copy()
    missing[4] = True
    even = on_even_times("r", time, 1.0, signals, missing, "linear")
    assert np.flatnonzero(even.lost).tolist() == [3, 4, 5, 7]
    np.testing.assert_allclose(even.signals["input"], np.arange(9))


def test_a_clock_of_gaps_is_refused():
    time = np.array([0.0, 0.1, 0.2, 50.0, 50.1, 50.2])
    signals = {"input": time, "output": time}
    with pytest.raises(InputError, match="give 'rows' between them"):
        on_even_times("r", time, 0.1, signals, NONE_LOST, "linear")


def test_the_step_is_the_usual_one():
    assert usual_step(np.array([0.0, 1.0, np.nan, 3.0, 4.0, 9.0])) == 1.0
