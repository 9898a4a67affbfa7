"""Shared measures of claims against hand-worked paths."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.compare.claims.statistics import (
    cycles,
    minor_turning_points,
    rank_correlation,
    turning_points,
)

numbers = st.lists(
    st.integers(-50, 50).map(float), min_size=3, max_size=20, unique=True
)


def test_rank_correlation_by_hand():
    # ranks 0 1 2 3 and 1 0 2 3: 1 - 6 * 2 / (4 * 15) = 0.8
    assert rank_correlation([1, 2, 3, 4], [20, 10, 30, 40]) == pytest.approx(0.8)


@given(numbers)
def test_rank_correlation_sees_order_alone(values):
    assert rank_correlation(values, [v**3 for v in values]) == pytest.approx(1)
    assert rank_correlation(values, [-v for v in values]) == pytest.approx(-1)


def test_one_point_has_no_trend():
    assert rank_correlation([1.0], [2.0]) == 0


def test_turning_points_by_hand():
    x = np.array([0, 5, 4.8, 5.1, 2, 2.1, 1.9, 4, 0.0])
    assert turning_points(x, 0.5).tolist() == [5.1, 1.9, 4]
    assert turning_points(x, 0.15).tolist() == [5, 4.8, 5.1, 1.9, 4]
    assert turning_points(-x, 0.5).tolist() == [-5.1, -1.9, -4]
    assert turning_points(np.zeros(5), 0.5).tolist() == []


@given(st.lists(st.integers(-9, 9).map(float), min_size=2, max_size=30))
def test_turning_points_alternate_by_more_than_the_swing(values):
    turns = turning_points(np.array(values), 2.5)
    steps = np.diff(turns)
    assert (np.abs(steps) > 2.5).all()
    assert (np.sign(steps[1:]) == -np.sign(steps[:-1])).all()


def test_minor_turns_by_hand():
    # range 0 to 10: the turns at 4 and 6 are inside, 9.5 is at the end
    x = np.array([0, 6, 4, 10, 0, 9.5, 0.0])
    assert minor_turning_points(x) == 2


def test_noise_makes_no_minor_loops():
    time = np.arange(4000) * 1e-3
    noise = np.random.default_rng(5).normal(0, 0.003, len(time))
    assert minor_turning_points(np.sin(2 * np.pi * time) + noise) == 0


def test_cycles_of_a_sine_on_an_offset():
    time = np.arange(10000) * 1e-4
    u = 0.01 + np.sin(2 * np.pi * 7.3 * time - 1)
    when, frequency, size = cycles(u, 2 * u + 5, 1e-4)
    np.testing.assert_allclose(frequency, 7.3, rtol=1e-4)
    np.testing.assert_allclose(size, 4, rtol=1e-3)
    # rises through its middle at phase 0, so the first whole cycle's middle is half a
    # cycle after 1 / (2 pi 7.3)
    assert when[0] == pytest.approx((1 / (2 * np.pi) + 0.5) / 7.3, abs=1e-4)


@given(st.floats(0, 0.005), st.integers(0, 2**32 - 1))
def test_noise_starts_no_cycle_of_a_chirp(rms, seed):
    time = np.arange(10000) * 1e-4
    # from 2 to 82 Hz: at first the noise is more than what u moves in ten samples
    phase = 2 * np.pi * (2 * time + 40 * time**2)
    noise = np.random.default_rng(seed).normal(0, rms, len(time))
    when, frequency, _ = cycles(np.sin(phase) + noise, np.sin(phase), 1e-4)
    # Of 42 turns: u is not clearly below before the first, nor above after the last.
    assert len(when) == 40
    # a cycle's frequency is that of a linear chirp in its middle
    np.testing.assert_allclose(frequency, 2 + 80 * when, rtol=0.02)


@given(
    st.lists(st.integers(-50, 50).map(float), min_size=2, max_size=30),
    st.integers(1, 60),
    st.integers(1, 4),
)
def test_points_on_the_way_add_no_turn(values, swing, parts):
    # whole numbers and quarters are exact, plateaus included
    ends = np.array(values)
    way = [a + (b - a) * k / 4 for a, b in pairwise(ends) for k in range(parts)]
    path = [*way, ends[-1]]
    found = turning_points(np.array(path), swing + 0.5)
    np.testing.assert_array_equal(found, _plain_turning_points(path, swing + 0.5))


def _plain_turning_points(path, swing):
    """Look from each turn for the farthest point before the path comes back."""
    found, start, side = [], 0, 0
    while True:
        for k in range(start, len(path)):
            part = path[start : k + 1]
            back = {1: max(part) - path[k], -1: path[k] - min(part)}
            sides = [s for s in (1, -1) if s != -side and back[s] > swing]
            if sides:
                break
        else:
            return found
        if side:
            found.append(max(part) if side == 1 else min(part))
        side, start = -sides[0] if not side else -side, k
