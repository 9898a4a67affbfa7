"""Bouc and Wen's hysteresis beside a path: its equation, its loops, its limits."""

import numpy as np
import pytest

from hystbench.blocks.bouc_wen import BoucWen

from .bare import along

SHARINGS = [0.0, 0.2, 0.5, 1.0]
TURNS = [0.0, 0.5, 0.3, 0.45, -0.6, -0.5, -0.55, 0.02]


def loop(sharing, weight=-0.7, yield_distance=0.15):
    return BoucWen(weight=weight, yield_distance=yield_distance, sharing=sharing)


def simulate(block, samples, dt=1e-3):
    z = np.asarray(samples, dtype=float)
    return block.simulate(z, z, dt)


@pytest.mark.parametrize("sharing", SHARINGS)
def test_it_is_the_solution_of_the_equation_beside_the_signal(sharing):
    def slope(z, h, direction):
        return 1 - np.abs(h) / 0.15 * (sharing + (1 - sharing) * np.sign(h * direction))

    way, wanted = along(slope, TURNS)
    # Where h passes zero the solver meets a corner of the equation.
    found = simulate(loop(sharing), way)
    np.testing.assert_allclose(found, way - 0.7 * wanted, atol=2e-6)


@pytest.mark.parametrize("sharing", SHARINGS)
def test_neither_the_rate_nor_the_sampling_matters(sharing):
    places = np.arange(8 * 7 + 1) / 8
    fine = np.interp(places, np.arange(len(TURNS)), TURNS)
    often = simulate(loop(sharing), fine, dt=1e-4)[::8]
    once = simulate(loop(sharing), TURNS, dt=2.0)
    np.testing.assert_allclose(once, often, rtol=0, atol=1e-14)


@pytest.mark.parametrize("sharing", [0.0, 0.2, 0.5])
def test_a_motion_that_is_repeated_returns_to_one_loop(sharing):
    z = 0.6 * np.sin(2 * np.pi * np.arange(12 * 400) / 400)
    once = simulate(loop(sharing), z)
    late = simulate(loop(sharing), np.concatenate([[2.0, -0.3], z]))[2:]
    last, before = once[-400:], once[-800:-400]
    np.testing.assert_allclose(last, before, rtol=0, atol=1e-9)
    np.testing.assert_allclose(late[-400:], last, rtol=0, atol=1e-9)
    np.testing.assert_allclose(last[200:], -last[:200], rtol=0, atol=1e-9)
    # As a force h takes work in every round, which is its area.
    assert np.sum((last - z[-400:]) / -0.7 * np.gradient(z[-400:])) > 0.05


def test_where_unloading_is_as_loading_there_is_no_loop():
    z = 0.6 * np.sin(2 * np.pi * np.arange(1200) / 400)
    wanted = z - 0.7 * 0.15 * np.sign(z) * -np.expm1(-np.abs(z) / 0.15)
    np.testing.assert_allclose(simulate(loop(1.0), z), wanted, rtol=0, atol=1e-12)


def test_the_operator_stays_within_the_yield_distance():
    walk = np.cumsum(np.random.default_rng(1).standard_normal(5000))
    beside = simulate(loop(0.3, weight=1.0), walk) - walk
    assert np.abs(beside).max() == pytest.approx(0.15, rel=1e-9)


@pytest.mark.parametrize("wrong", [np.nan, np.inf])
def test_a_missing_sample_shows_from_there_on(wrong):
    y = simulate(loop(0.3), [0.1, wrong, 0.1])
    assert np.isfinite(y[0])
    assert not np.isfinite(y[1:]).any()
