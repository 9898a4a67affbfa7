"""Channels that repeat a value: clipped and stuck ones, and honest turns."""

import numpy as np
import pytest

from hystbench.flat import flats, held_for
from tests.gap.made import play
from tests.inspection.made import sine


def test_a_sine_cut_off_is_clipped_where_it_is():
    u = np.minimum(sine(5), 0.9)
    (found,) = flats(u)
    assert (found.kind, found.value) == ("clipped", 0.9)
    assert (found.samples, found.stretches) == (np.count_nonzero(u == 0.9), 6)
    assert u[found.first] == 0.9
    assert u[found.first - 1] < 0.9


def test_both_ends_are_told_apart():
    u = np.clip(sine(5), -0.8, 0.9)
    assert [x.value for x in flats(u)] == [0.9, -0.8]


@pytest.mark.parametrize("step", [0, 1e-4, 0.01, 0.05])
@pytest.mark.parametrize("hz", [1, 5, 40])
def test_a_digitized_turn_is_not_clipped(hz, step):
    u = sine(hz)
    assert flats(np.round(u / step) * step if step else u) == []


def test_a_backlash_that_stands_at_its_turn_is_not_clipped():
    assert flats(play(sine(5), 0.2)) == []


def test_a_held_value_that_jumps_back_is_stuck():
    u = sine(5)
    u[410:430] = u[410]
    (found,) = flats(u)
    assert (found.kind, found.first, found.samples) == ("stuck", 410, 20)


def test_a_staircase_and_a_constant_are_neither():
    assert flats(np.repeat(np.arange(50.0), 20)) == []
    assert flats(np.ones(100)) == []


def test_noise_that_is_cut_off_is_clipped():
    y = sine(5) + 0.01 * np.random.default_rng(0).standard_normal(1200)
    assert [x.kind for x in flats(np.minimum(y, 0.8))] == ["clipped"]
    assert flats(y) == []


def test_readings_of_few_digits_are_alike_by_chance_and_not_stuck():
    noise = 0.04 * np.random.default_rng(0).standard_normal((20, 1200))
    coarse = np.round((sine(5) + noise) / 0.03) * 0.03
    assert all(flats(y) == [] for y in coarse)
    moves = np.diff(coarse[0])
    held = next(k for k in range(410, 450) if (moves[k - 4 : k] != 0).all())
    coarse[0, held : held + 20] = coarse[0, held]
    (found,) = flats(coarse[0])
    assert (found.kind, found.first) == ("stuck", held)


@pytest.mark.parametrize("levels", [32, 64])
def test_a_digitized_backlash_is_not_clipped(levels):
    y = play(sine(5), 0.2)
    step = np.ptp(y) / levels
    assert flats(np.round(y / step) * step) == []


def test_a_sensor_that_is_read_slowly_is_told_by_its_changes():
    y = sine(3)
    assert held_for(np.repeat(y[::5], 5)[2:]) == 5
    assert held_for(y) == held_for(np.round(y, 1)) == held_for(np.minimum(y, 0.8)) == 1
    assert held_for(np.ones(100)) == held_for(np.repeat([1.0, 2.0, 3.0], 10)) == 1
