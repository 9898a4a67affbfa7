"""Blocks that wrap hysteresis against plain loops; how they compose."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.blocks import registry
from hystbench.blocks.butterfly import Butterfly
from hystbench.blocks.gpi import GeneralizedPrandtlIshlinskii
from hystbench.blocks.hysteresis import MaterialHysteresis
from hystbench.blocks.hysteresis_shape import HysteresisShape
from hystbench.blocks.prandtl_ishlinskii import PrandtlIshlinskii
from hystbench.blocks.rate_dependent_hysteresis import RateDependentHysteresis
from hystbench.blocks.wrapping import Wrapped
from hystbench.envelope import Envelope
from hystbench.errors import InputError
from hystbench.model import Model
from hystbench.operators import generalized_prandtl_ishlinskii, growing_play
from hystbench.record import Channel

from .examples import EXAMPLES

DT = 1e-3
GPI = GeneralizedPrandtlIshlinskii.from_mapping(EXAMPLES["gpi"])
SHAPE = HysteresisShape(
    thresholds=[0.05, 0.3],
    weights=[0.4, -0.2],
    square_weights=[0.1, 0.3],
    powers=[0.5, -0.1, 0.2],
)
GROWING = RateDependentHysteresis(coefficient=0.05, exponent=0.7)
EXCESS = RateDependentHysteresis(coefficient=0.01, exponent=0.5, form="excess-field")
BUTTERFLY = Butterfly(coefficient=-0.3, threshold=0.2)
PLAYS = PrandtlIshlinskii(
    thresholds=[0.0, 0.1, 0.4],
    weights=[-0.2, 0.5, -0.1],
    square_weights=[0.2, -0.4, 0.1],
    cube_weights=[0.3, -0.2, 0.1],
)
inputs = st.lists(st.floats(-2, 2), min_size=2, max_size=60).map(np.array)


def rates(v):
    """Central differences, one-sided at the ends, one by one."""
    last = len(v) - 1
    return [
        (v[min(k + 1, last)] - v[max(k - 1, 0)])
        / (DT * (min(k + 1, last) - max(k - 1, 0)))
        for k in range(len(v))
    ]


def plain_play(v, threshold, growth):
    w, out = 0.0, []
    for value, factor in zip(v, growth, strict=True):
        r = threshold * factor
        w = max(value - r, min(value + r, w))
        out.append(w)
    return np.array(out)


def plain_gpi(block, v, growth):
    envelope = Envelope(*block.envelope)
    total = np.zeros(len(v))
    for threshold, weight in zip(block.thresholds, block.weights, strict=True):
        w = 0.0
        for k, value in enumerate(v):
            r = threshold * growth[k]
            low, high = envelope.right(value) - r, envelope.left(value) + r
            w = max(low, min(high, w))
            total[k] += weight * w
    return total


def plain_shape(block, v, growth):
    y = sum(c * v**k for k, c in enumerate(block.powers, start=1))
    for i, threshold in enumerate(block.thresholds):
        p = plain_play(v, threshold, growth)
        y = y + block.weights[i] * p + block.square_weights[i] * p**2
    return y


def plain_growth(block, v):
    return np.array(
        [1 + block.coefficient * abs(r) ** block.exponent for r in rates(v)]
    )


def close(found, expected):
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12)


def chain(*blocks):
    return Model("m", Channel("u", "A"), Channel("y", "um"), blocks)


def test_hysteresis_is_a_gpi_by_another_name():
    v = np.sin(np.arange(100) / 7)
    block = MaterialHysteresis.from_mapping(EXAMPLES["gpi"])
    close(block.simulate(v, v, DT), plain_gpi(GPI, v, np.ones(100)))


@given(inputs)
def test_growing_thresholds(v):
    expected = plain_gpi(GPI, v, plain_growth(GROWING, v))
    close(chain(GPI, GROWING).simulate(v, DT), expected)


@pytest.mark.parametrize("knee", [0.0, 3.0])
@pytest.mark.parametrize("form", ["growing-thresholds", "excess-field"])
def test_along_straight_lines_the_rate_is_that_of_the_line(form, knee):
    """As with a grid so fine that steps no longer matter: slow up and fast down."""
    coefficient = 0.05 if form == "growing-thresholds" else 0.01
    numbers = {"coefficient": coefficient, "exponent": 0.7, "form": form, "knee": knee}
    v = np.interp(np.arange(80), [0, 9, 12, 25, 27, 60, 79], [0, 2, -1, 1, -2, 2, 0])
    found = chain(GPI, RateDependentHysteresis(**numbers, hold="linear"))
    fine, steps = np.repeat(np.diff(v) / DT, 200), np.arange(79 * 200 + 1) / 200
    rate = np.append(0.0, fine)  # of the line that leads to each point
    if knee:
        effect = coefficient * knee**0.7 * np.arcsinh((abs(rate) / knee) ** 0.7)
    else:
        effect = coefficient * abs(rate) ** 0.7
    path = np.interp(steps, np.arange(80), v)
    if form == "excess-field":
        path, growth = path - effect * np.sign(rate), np.ones(len(path))
    else:
        growth = 1.0 + effect
    expected = plain_gpi(GPI, path, growth)[::200]
    np.testing.assert_allclose(
        found.simulate(v, DT)[1:], expected[1:], atol=2e-3 * np.ptp(expected)
    )


def test_a_knee_needs_a_rate_that_is_known():
    with pytest.raises(InputError, match="knee: none with 'form: acting-field'"):
        RateDependentHysteresis(
            coefficient=0.1, exponent=0.5, form="acting-field", knee=1.0
        )


@given(inputs)
def test_excess_field(v):
    effect = [
        np.sign(r) * EXCESS.coefficient * abs(r) ** EXCESS.exponent for r in rates(v)
    ]
    expected = plain_gpi(GPI, v - np.array(effect), np.ones(len(v)))
    close(chain(GPI, EXCESS).simulate(v, DT), expected)


@given(inputs)
def test_shape(v):
    still = np.ones(len(v))
    expected = plain_gpi(GPI, v, still) + plain_shape(SHAPE, v, still)
    close(chain(GPI, SHAPE).simulate(v, DT), expected)


@given(inputs)
def test_butterfly(v):
    still, growth = np.ones(len(v)), plain_growth(GROWING, v)
    expected = plain_gpi(GPI, v, still) - 0.3 * plain_play(v, 0.2, still) ** 2
    close(chain(GPI, BUTTERFLY).simulate(v, DT), expected)
    grown = plain_gpi(GPI, v, growth) - 0.3 * plain_play(v, 0.2, growth) ** 2
    close(chain(GPI, BUTTERFLY, GROWING).simulate(v, DT), grown)


@given(inputs)
def test_plays_beside_a_linear_path(v):
    for growth, blocks in (
        (np.ones(len(v)), (PLAYS,)),
        (plain_growth(GROWING, v), (PLAYS, GROWING)),
    ):
        expected = v.copy()
        for r, w, s, c in zip(*vars(PLAYS).values(), strict=True):
            p = plain_play(v, r, growth)
            expected += w * p + s * p**2 + c * p**3
        close(chain(*blocks).simulate(v, DT), expected)


@pytest.mark.parametrize("key", ["weights", "square_weights", "cube_weights"])
def test_plays_need_one_weight_a_threshold(key):
    with pytest.raises(InputError, match=f"{key}: expected 2 numbers.* got 1"):
        PrandtlIshlinskii.from_mapping(
            {"thresholds": [0.1, 0.2], "weights": [1.0, 1.0], key: [1.0]}
        )


def acting(v, coefficient, exponent, dt):
    """Give the field that acts: what drives a hysteresis that is none."""
    straight = PrandtlIshlinskii(thresholds=[0.0], weights=[0.0])
    block = RateDependentHysteresis(
        coefficient=coefficient, exponent=exponent, form="acting-field", hold="linear"
    )
    return block.wrap(straight, v, v, dt, None)


@pytest.mark.parametrize("exponent", [0.4, 0.5, 0.7, 1.0, 1.6])
def test_behind_a_steady_rise_the_acting_field_lags_by_a_power_of_the_rate(exponent):
    t = np.arange(12_000) * 1e-4
    field = acting(-3.0 * t, 0.02, exponent, 1e-4)
    assert 3.0 * t[-1] > 5 * 0.02 * 3.0**exponent  # time enough to get there
    assert field[-1] == pytest.approx(-3.0 * t[-1] + 0.02 * 3.0**exponent, rel=1e-6)


@pytest.mark.parametrize("exponent", [0.4, 0.5, 0.7, 1.6])
def test_behind_a_step_the_acting_field_comes_as_in_closed_form(exponent):
    """``x' = -(x / c)^p``, p = 1 / a, gives ``x^(1-p) = x0^(1-p) + (p-1) c^-p t``."""
    dt, c, p = 1e-5, 0.02, 1 / exponent
    t = np.arange(2000) * dt
    field = acting(np.append(0.0, np.ones(2000)), c, exponent, dt)[1:]
    rest = np.maximum(1.0 + (p - 1) * c**-p * (t + dt), 0.0) ** (1 / (1 - p))
    late = t > 100 * dt  # implicit Euler is of first order, and rough at the jump
    np.testing.assert_allclose((1 - field)[late], rest[late], rtol=0.02)


def test_with_an_exponent_of_one_the_acting_field_is_a_first_order_lag():
    dt, tau = 1e-5, 2e-3
    t = np.arange(4000) * dt
    w = 2 * np.pi * 50
    field = acting(np.sin(w * t), tau, 1.0, dt)
    steady = np.sin(w * t - np.arctan(w * tau)) / np.hypot(1, w * tau)
    expected = steady + np.exp(-t / tau) * w * tau / (1 + (w * tau) ** 2)
    np.testing.assert_allclose(field, expected, rtol=0, atol=w * dt)


def test_a_coefficient_of_zero_takes_nothing_of_the_field():
    v = np.sin(np.arange(50) / 5)
    np.testing.assert_array_equal(acting(v, 0.0, 0.5, DT), v)


def test_an_acting_field_hides_no_number_that_is_none():
    v = np.array([0.0, 0.1, np.nan, 0.2, 0.3])
    assert np.isnan(acting(v, 0.02, 0.5, DT)[2:]).any()


@given(inputs)
def test_rate_dependence_around_shape_grows_both(v):
    growth = plain_growth(GROWING, v)
    expected = plain_gpi(GPI, v, growth) + plain_shape(SHAPE, v, growth)
    close(chain(GPI, SHAPE, GROWING).simulate(v, DT), expected)


@given(inputs)
def test_shape_around_rate_dependence_does_not_grow(v):
    growth = plain_growth(GROWING, v)
    expected = plain_gpi(GPI, v, growth) + plain_shape(SHAPE, v, np.ones(len(v)))
    close(chain(GPI, GROWING, SHAPE).simulate(v, DT), expected)


@given(inputs)
def test_two_growths_multiply(v):
    growth = plain_growth(GROWING, v) ** 2
    close(chain(GPI, GROWING, GROWING).simulate(v, DT), plain_gpi(GPI, v, growth))


@pytest.mark.parametrize("block", [GROWING, EXCESS])
def test_the_loop_widens_with_the_rate(block):
    def area(frequency):
        v = np.sin(2 * np.pi * frequency * np.arange(2000) * DT)
        y = chain(GPI, block).simulate(v, DT)
        last = slice(-round(1 / (frequency * DT)), None)
        return abs(np.sum(y[last] * np.gradient(v)[last]))

    assert area(10.0) > 1.05 * area(1.0)


@pytest.mark.parametrize("name", ["bouc-wen", "preisach", "jiles-atherton", "rdgpi"])
def test_excess_field_drives_any_hysteresis(name):
    inner = registry()[name].from_mapping(EXAMPLES[name])
    v = 0.5 * np.sin(np.arange(300) / 9)
    effect = np.array(
        [np.sign(r) * EXCESS.coefficient * abs(r) ** EXCESS.exponent for r in rates(v)]
    )
    close(chain(inner, EXCESS).simulate(v, DT), inner.simulate(v - effect, v, DT))
    with pytest.raises(InputError, match=f"block 2 .*'{name}' has no thresholds"):
        chain(inner, GROWING)
    # also through another block that wraps
    with pytest.raises(InputError, match=f"block 3 .*'{name}' has no thresholds"):
        chain(inner, SHAPE, GROWING)


def test_steps_join_hysteresis_and_what_wraps_it():
    gain = registry()["gain"].from_mapping(EXAMPLES["gain"])
    steps = chain(gain, GPI, SHAPE, GROWING, gain).steps
    assert steps == (gain, Wrapped(Wrapped(GPI, SHAPE), GROWING), gain)


def test_parameters_of_wrapping_blocks_are_the_models():
    model = chain(GPI, GROWING)
    doubled = model.with_values({"rate-dependent-hysteresis.coefficient": 0.1})
    v = np.sin(np.arange(50))
    growth = 1 + 2 * (plain_growth(GROWING, v) - 1)
    close(doubled.simulate(v, DT), plain_gpi(GPI, v, growth))


@pytest.mark.parametrize("key", ["weights", "square_weights"])
def test_shape_needs_one_weight_a_threshold(key):
    with pytest.raises(InputError, match=f"{key}: expected 2 numbers.* got 1"):
        HysteresisShape.from_mapping(
            {"thresholds": [0.1, 0.2], "weights": [1.0, 1.0], key: [1.0]}
        )


@pytest.mark.parametrize(
    ("growth", "expected"),
    [([1.0, -1.0], "growth: a negative"), ([1.0], r"growth: \(1,\) given")],
)
def test_a_growth_that_is_none_is_refused(growth, expected):
    v = np.zeros(2)
    with pytest.raises(InputError, match=expected):
        growing_play(v, [0.1], growth)
    with pytest.raises(InputError, match=expected):
        generalized_prandtl_ishlinskii(v, v, [0.1], [1.0], growth)
