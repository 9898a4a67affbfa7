"""Error measures against values by hand and against each other."""

import numpy as np
import pytest

from hystbench.errors import InputError
from hystbench.metrics import (
    mean_square_error,
    relative_error,
    smoothed_squared_error,
)


def test_mean_square_error_by_hand():
    assert mean_square_error([3, -4, 0, 1]) == pytest.approx(26 / 4)


def test_relative_error_by_hand():
    # sums of squares 25 and 100
    assert relative_error([3, 4], [6, 8]) == pytest.approx(0.5)


def test_mean_square_error_is_relative_error_times_power():
    e, d = np.array([0.1, -0.2, 0.4]), np.array([1.0, 2.0, -4.0])
    power = (1 + 4 + 16) / 3
    assert mean_square_error(e) == pytest.approx(relative_error(e, d) ** 2 * power)


def test_smoothed_squared_error_by_hand():
    smooth = smoothed_squared_error([1, 2, 3, 4], 2)
    assert smooth == pytest.approx([2.5, 6.5, 12.5])


@pytest.mark.parametrize("window", [1, 3, 4, 7, 10])
def test_smoothed_squared_error_is_the_mean_of_each_window(window):
    """Small squares stay exact beside large ones, as after a filter has converged."""
    e = np.array([1e6, 3e5, 2.0, 1e-6, 3e-6, 2e-6, 1e-6, 5e-6, 4e-6, 1e-6])
    smooth = smoothed_squared_error(e, window)
    means = [mean_square_error(e[k : k + window]) for k in range(11 - window)]
    assert smooth == pytest.approx(means, rel=1e-14, abs=0)


def test_smoothed_squared_error_over_all_is_the_mean_square_error():
    e = [1.0, -2.0, 5.0]
    assert smoothed_squared_error(e, 3) == pytest.approx([mean_square_error(e)])


@pytest.mark.parametrize(
    ("broken", "told"),
    [
        (lambda: mean_square_error([]), "e: "),
        (lambda: relative_error([1, 2], [1]), "d: 1 samples given, e has 2"),
        (lambda: relative_error([1], [0]), "zero throughout"),
        (lambda: smoothed_squared_error([1, 2], 3), "window: 3 given, 1 to 2"),
        (lambda: smoothed_squared_error([1, 2], 0), "window: 0 given, 1 to 2"),
    ],
)
def test_what_cannot_be_measured_is_refused(broken, told):
    with pytest.raises(InputError, match=told):
        broken()
