"""The block ``jiles-atherton`` against a plain integration and in its limits."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from hystbench.blocks.asymmetry import Asymmetry
from hystbench.blocks.jiles_atherton import JilesAtherton, langevin
from hystbench.errors import InputError

BLOCK = JilesAtherton(
    saturation=10.0, shape=0.3, coupling=0.4, pinning=0.15, reversibility=0.2, bias=0.1
)
blocks = st.builds(
    lambda shape, coupling, pinning, reversibility, bias: JilesAtherton(
        saturation=1.0,
        shape=shape,
        coupling=coupling * shape,
        pinning=pinning,
        reversibility=reversibility,
        bias=bias,
    ),
    st.floats(0.05, 3),
    st.floats(0, 2.9),
    st.floats(0.02, 3),
    st.floats(0, 1),
    st.floats(-1, 1),
)
inputs = st.lists(st.floats(-1, 1), min_size=1, max_size=20)


def simulate(block, samples):
    z = np.array(samples, dtype=float)
    return block.simulate(z, z, 1e-4)


def man(x):
    return x / 3 - x**3 / 45 if abs(x) < 1e-3 else 1 / math.tanh(x) - 1 / x


def man_slope(x):
    return 1 / 3 - x**2 / 15 if abs(x) < 1e-3 else 1 / x**2 - 1 / math.sinh(x) ** 2


def plain(block, samples):
    """Integrate Jiles and Atherton's m_irr and m over the field, to nine digits."""
    a, alpha, k, c = block.shape, block.coupling, block.pinning, block.reversibility
    start = brentq(lambda m: man((block.bias + alpha * m) / a) - m, -1, 1, xtol=1e-15)
    m, h, out = start, block.bias, []
    for z in samples:
        direction = math.copysign(1, block.bias + z - h)

        def slope(field, state, direction=direction):
            x = (field + alpha * state[0]) / a
            irreversible = (state[0] - c * man(x)) / (1 - c)
            gap = man(x) - irreversible
            grows = gap / (k * direction) if gap * direction > 0 else 0.0
            per_effective = (1 - c) * grows + c * man_slope(x) / a
            return [per_effective / (1 - alpha * per_effective)]

        if block.bias + z != h:
            solved = solve_ivp(
                slope, (h, block.bias + z), [m], rtol=1e-9, atol=1e-11, max_step=0.02
            )
            m, h = solved.y[0, -1], block.bias + z
        out.append(block.saturation * (m - start))
    return np.array(out)


@pytest.mark.parametrize(
    "change",
    [
        {},
        {"reversibility": 0.0, "bias": 0.0},
        {"coupling": 0.8},
        {"coupling": 0.0, "pinning": 0.03},
        {"shape": 0.05, "coupling": 0.1, "bias": -0.5},
    ],
)
def test_it_is_the_plain_integration(change):
    block = replace(BLOCK, **change)
    samples = np.concatenate(
        [0.6 * np.sin(np.linspace(0, 9, 40)), [0.2, -0.2, 0.3, 0.3, 0.9, -1.0]]
    )
    np.testing.assert_allclose(
        simulate(block, samples),
        plain(block, samples),
        rtol=0,
        atol=1e-4 * block.saturation,
    )


@given(blocks, inputs, st.integers(2, 9))
def test_it_depends_on_the_path_alone(block, samples, slower):
    places = np.arange((len(samples) - 1) * slower + 1) / slower
    path = np.interp(places, np.arange(len(samples)), samples)
    fine, coarse = simulate(block, path)[::slower], simulate(block, samples)
    np.testing.assert_allclose(fine, coarse, rtol=0, atol=1e-3)


@given(blocks, inputs)
def test_no_negative_susceptibility(block, samples):
    y = simulate(block, [0.0, *samples])
    assert (np.diff(y) * np.diff([0.0, *samples]) >= 0).all()
    assert np.abs(y).max() <= 2


def test_without_the_guard_the_slope_would_be_negative():
    # just after a turn the magnetization lies beyond the anhysteretic curve
    block = replace(BLOCK, reversibility=0.0, coupling=0.0, bias=0.0)
    y = simulate(block, [0.6, 0.599])
    m = y[0] / block.saturation
    assert m < man(0.599 / block.shape)  # so that gap / (-pinning) < 0
    assert y[1] == y[0]


@given(blocks, inputs)
def test_all_reversible_it_is_anhysteretic(block, samples):
    free = replace(block, reversibility=1.0)
    start = free.anhysteretic(free.bias)
    expected = [free.anhysteretic(free.bias + z) - start for z in samples]
    np.testing.assert_allclose(simulate(free, samples), expected, rtol=0, atol=1e-3)


@given(blocks, st.floats(-1, 1))
def test_the_anhysteretic_curve_solves_its_equation(block, field):
    m = block.anhysteretic(field)
    x = (field + block.coupling * m) / block.shape
    assert m == pytest.approx(man(x), abs=1e-7)


def test_without_bias_the_settled_loop_is_symmetric():
    period = 400
    z = 0.6 * np.sin(2 * np.pi * np.arange(8 * period) / period)
    y = simulate(replace(BLOCK, bias=0.0), z)
    last, half_before = y[-period:], y[-3 * period // 2 : -period // 2]
    np.testing.assert_allclose(last, -half_before, rtol=0, atol=1e-4 * 10)
    assert np.sum(z[-period:] * np.gradient(y)[-period:]) > 0.1  # it costs energy


def test_langevin_near_zero_and_far():
    assert langevin(1e-5) == pytest.approx(1e-5 / 3, rel=1e-9)
    assert langevin(-2.0) == pytest.approx(0.5 - 1 / math.tanh(2.0))
    assert langevin(1e6) == pytest.approx(1 - 1e-6)


@pytest.mark.parametrize("wrong", [np.nan, np.inf])
def test_a_missing_sample_shows_from_there_on(wrong):
    y = simulate(BLOCK, [0.1, wrong, 0.1])
    assert np.isfinite(y[0])
    assert np.isnan(y[1:]).all()


def test_a_coupling_that_makes_the_curve_vertical_is_refused():
    with pytest.raises(InputError, match=r"coupling: 0.9 is too large.* 0.87"):
        replace(BLOCK, coupling=0.9)


def test_the_square_of_the_magnetization_is_an_asymmetry_behind_it():
    """As the page on model files writes a displacement of ``g m^2``."""
    field = {
        "shape": 1.0,
        "coupling": 0.5,
        "pinning": 0.4,
        "reversibility": 0.2,
        "bias": 1.5,
    }
    start = JilesAtherton(saturation=1.0, **field).anhysteretic(1.5)
    g = 3.0
    z = 1.2 * np.sin(np.linspace(0, 12, 900))
    m = start + JilesAtherton(saturation=1.0, **field).simulate(z, z, 1e-3)
    behind = Asymmetry(coefficient=1 / (4 * g * start**2))
    linear = JilesAtherton(saturation=2 * g * start, **field).simulate(z, z, 1e-3)
    found = behind.simulate(linear, z, 1e-3)
    np.testing.assert_allclose(found, g * (m**2 - start**2), atol=1e-12)


def test_its_slope_is_that_of_the_textbook_in_irreversible_magnetization():
    """``(1 - c) dm_irr/de + c dman/de`` with m_irr of the whole m."""
    c, k, man, m = 0.3, 0.7, 0.6, 0.2
    irreversible = (m - c * man) / (1 - c)
    assert (1 - c) * (man - irreversible) / k == pytest.approx((man - m) / k)
