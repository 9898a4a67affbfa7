"""The smooth curve through samples: what it meets, and how it goes on at the ends."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.blocks.curve import (
    AHEAD,
    POINTS,
    SHORT_STEPS,
    coarser,
    continued,
    finer,
    held_lines,
    value_at,
    weighed,
)

SAMPLES = 400
MIDDLE = slice(AHEAD + 1, -AHEAD - 1)


def sine(frequency, fine=1):
    """Sample a sine of a frequency per sample."""
    place = np.arange((SAMPLES - 1) * fine + 1) / fine
    return np.sin(2 * np.pi * frequency * place + 0.4)


@given(st.lists(st.floats(-1, 1), min_size=1, max_size=60), st.integers(1, 4))
def test_it_passes_through_the_samples(samples, factor):
    v = np.array(samples)
    np.testing.assert_array_equal(finer(v, factor)[::factor], v)


@pytest.mark.parametrize(
    ("frequency", "error"), [(0.01, 1e-14), (0.15, 1e-11), (0.2, 1e-8), (0.25, 5e-6)]
)
def test_a_sine_is_met(frequency, error):
    away = np.abs(finer(sine(frequency), 8) - sine(frequency, 8))
    assert away[8 * MIDDLE.start : 8 * MIDDLE.stop].max() < error


@pytest.mark.parametrize("n", [1, 2, 3, 10, 16, 17, 40])
def test_at_its_ends_a_record_is_turned_about_them(n):
    v = np.random.default_rng(n).standard_normal(n)
    longer = continued(v)
    first = AHEAD + 1
    assert len(longer) == n + POINTS - 1
    np.testing.assert_array_equal(longer[first : first + n], v)
    for k in range(1, min(n - 1, AHEAD) + 1):
        assert longer[first - k] + longer[first + k] == pytest.approx(2 * v[0])
        last = first + n - 1
        assert longer[last + k] + longer[last - k] == pytest.approx(2 * v[-1])


@pytest.mark.parametrize("n", [2, 3, 10, 40])
def test_a_straight_record_stays_straight(n):
    v = 3.0 - 0.5 * np.arange(n)
    places = np.arange(n + POINTS - 1) - AHEAD - 1.0
    np.testing.assert_allclose(continued(v), 3.0 - 0.5 * places, atol=1e-12)


def test_a_lone_sample_stays_where_it_is():
    np.testing.assert_array_equal(continued(np.array([2.5])), np.full(POINTS, 2.5))


@pytest.mark.parametrize("n", [1, 7, 50])
def test_samples_are_weighed_as_by_a_sum(n):
    random = np.random.default_rng(3)
    v, weights = random.standard_normal(n), random.standard_normal((3, POINTS))
    longer = continued(v)
    wanted = [[row @ longer[k : k + POINTS][::-1] for k in range(n)] for row in weights]
    np.testing.assert_allclose(weighed(v, weights), wanted, rtol=1e-12, atol=1e-12)


def test_its_value_is_that_of_the_polynomial():
    # A polynomial of so low a degree is met exactly.
    newest = 2.0
    samples = newest - np.arange(6)
    place = -2.3
    found = value_at(6, place) @ (samples**5 - samples)
    at = newest + place
    assert found == pytest.approx(at**5 - at, rel=1e-11)


@pytest.mark.parametrize("frequency", [0.02, 0.05, 0.1])
def test_straight_lines_hold_a_sine_as_large_as_it_is(frequency):
    lines, fine = held_lines(sine(frequency), "band-limited")
    assert fine == 2
    # The part at the frequency of a signal that is straight between its corners:
    # sinc^2 times that of the corners.
    place = np.arange(len(lines)) / fine
    wave = np.exp(-2j * np.pi * frequency * place)
    whole = slice(60 * fine, (60 + 200) * fine)  # periods of all three
    corners = 2j * np.mean(lines[whole] * wave[whole]) * np.exp(-0.4j)
    held = corners * np.sinc(frequency / fine) ** 2
    assert abs(held - 1) < 1e-5
    assert abs(corners - 1) > 2e-4


@pytest.mark.parametrize("count", [20, 50, 200])
def test_corners_of_a_triangle_are_rounded_by_0_8_of_its_amplitude_a_sample(count):
    """docs/tutorial.md says so, and that of straight lines beside it."""
    n = np.arange(10 * count + 1)
    triangle = 2 / np.pi * np.arcsin(np.sin(2 * np.pi * n / count))
    lines, fine = held_lines(triangle, "band-limited")
    true = np.interp(np.arange(len(lines)) / fine, n, triangle)
    whole = slice(30 * fine, -30 * fine)
    assert np.abs(lines - true)[whole].max() == pytest.approx(0.83 / count, rel=0.02)
    # Straight lines make a sine smaller by the square of sinc.
    assert 1 - np.sinc(1 / count) ** 2 == pytest.approx(3.3 / count**2, rel=0.01)


def test_other_holds_take_the_samples():
    v = sine(0.1)
    for hold in ("linear", "zero-order"):
        lines, fine = held_lines(v, hold)
        assert fine == 1
        np.testing.assert_array_equal(lines, v)


def test_coarser_undoes_finer():
    v = sine(0.05) + 0.3 * sine(0.2)
    found = coarser(finer(v, SHORT_STEPS))
    assert found.shape == v.shape
    np.testing.assert_allclose(found[MIDDLE], v[MIDDLE], atol=3e-3)


@pytest.mark.parametrize(("frequency", "size"), [(0.3, 1.0), (0.62, 0.0), (1.4, 0.0)])
def test_coarser_passes_what_is_below_half_the_coarse_rate(frequency, size):
    place = np.arange((SAMPLES - 1) * SHORT_STEPS + 1) / SHORT_STEPS
    fine = np.sin(2 * np.pi * frequency * place)
    wanted = size * np.sin(2 * np.pi * frequency * np.arange(SAMPLES))
    np.testing.assert_allclose(coarser(fine)[MIDDLE], wanted[MIDDLE], atol=3e-3)
