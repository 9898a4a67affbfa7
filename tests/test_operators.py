"""Compiled operators against the paper's equations, written out plainly."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from hystbench import kernels, operators
from hystbench.envelope import PUBLISHED_ENVELOPE, Envelope, equal_intervals, thresholds
from hystbench.errors import InputError
from hystbench.operators import (
    enveloped_plays,
    generalized_play,
    generalized_prandtl_ishlinskii,
    play,
    rate_dependent_prandtl_ishlinskii,
    state_space,
)

# Steps of 1/1024: equal values then are equal, and differences are exact.
VALUES = st.integers(-640, 640).map(lambda value: value / 1024)
INPUTS = st.lists(VALUES, min_size=1, max_size=60).map(np.array)
# tanh envelopes that never cross: the same slope, the left one higher
ENVELOPES = st.builds(
    lambda slope, height, gap, place: Envelope(
        height, slope, 0.1, place + gap, height, slope, 0.1, place
    ),
    st.floats(0.1, 3),
    st.floats(0.1, 2),
    st.floats(0.01, 1),
    st.floats(-0.5, 0.5),
)
THRESHOLDS = arrays(float, st.integers(1, 12), elements=st.floats(0, 0.8)).map(np.sort)


def plain_equation_4(left, right, r, w):
    out = np.empty((len(left), len(r)))
    w = np.array(w, dtype=float)
    for k in range(len(left)):
        for i in range(len(r)):
            w[i] = max(right[k] - r[i], min(left[k] + r[i], w[i]))
        out[k] = w
    return out


def plain_equation_12(v, before, left, right, r, w):
    out = np.empty((len(left), len(r)))
    w = np.array(w, dtype=float)
    for k in range(len(left)):
        for i in range(len(r)):
            if v[k] > before and right[k] - r[i] > w[i]:
                w[i] = right[k] - r[i]
            elif v[k] < before and left[k] + r[i] < w[i]:
                w[i] = left[k] + r[i]
        before = v[k]
        out[k] = w
    return out


def on(envelope, v):
    return envelope.left(v), envelope.right(v)


def sides(form, v, before, left, right):
    """Envelopes as Eq. 4 takes them; for Eq. 12 the input before gives a direction."""
    if form == "eq4":
        return left, right
    path = np.concatenate(([before], v))
    both = [np.concatenate((side[:1], side)) for side in (left, right)]
    operators.follow_direction(path, *both)
    return both[0][1:], both[1][1:]


# --- envelopes and thresholds


def test_published_envelope_is_the_papers():
    u = np.linspace(-0.632, 0.632, 7)
    left, right = on(PUBLISHED_ENVELOPE, u)
    assert left == pytest.approx(1.2878 * np.tanh(0.36 * u + 0.6025) - 0.6671)
    assert right == pytest.approx(0.3223 * np.tanh(1.2233 * u + 0.1104) - 0.0248)


def test_envelope_goes_to_a_dictionary_and_back():
    assert Envelope(**PUBLISHED_ENVELOPE.to_dict()) == PUBLISHED_ENVELOPE


def test_an_envelope_that_is_not_finite_is_refused():
    with pytest.raises(InputError, match=r"envelope\.a0: nan"):
        Envelope(np.nan, 1, 1, 1, 1, 1, 1, 1)


def test_thresholds_by_equation_10():
    envelope = Envelope(1, 1, 0, 0.5, 3, 1, 0, 0)  # at 1: 1.26 left, 2.28 right
    r = thresholds(envelope, 1.0, 3)
    assert r == pytest.approx(np.array([0, 1, 2, 3]) / 4 * 3 * np.tanh(1))
    assert equal_intervals(0.8, 3) == pytest.approx([0, 0.2, 0.4, 0.6])


@pytest.mark.parametrize("amplitude", [0.0, -1.0, np.nan, np.inf])
def test_thresholds_need_a_positive_amplitude(amplitude):
    with pytest.raises(InputError, match="amplitude"):
        equal_intervals(amplitude, 3)
    with pytest.raises(InputError, match="order: -1"):
        equal_intervals(1.0, -1)


# --- the operators against plain loops


@given(INPUTS, ENVELOPES, THRESHOLDS, st.floats(-2, 2))
def test_equation_4_as_written(v, envelope, r, start):
    left, right = on(envelope, v)
    state = np.full(len(r), start)
    expected = plain_equation_4(left, right, r, state)
    outputs = generalized_play(left, right, r, state)
    np.testing.assert_array_equal(outputs, expected)


@given(INPUTS, VALUES, THRESHOLDS, st.floats(-2, 2))
def test_equation_12_as_written(v, before, r, start):
    # the published envelopes cross: Eq. 12 must be right there as well
    left, right = on(PUBLISHED_ENVELOPE, v)
    state = np.full(len(r), start)
    expected = plain_equation_12(v, before, left, right, r, state)
    twelve = sides("eq12", v, before, left, right)
    outputs = generalized_play(*twelve, r, state)
    np.testing.assert_array_equal(outputs, expected)


@given(INPUTS, THRESHOLDS)
def test_play_as_written(v, r):
    outputs = play(v, r)
    expected = plain_equation_4(v, v, r, np.zeros(len(r)))
    np.testing.assert_array_equal(outputs, expected)


@given(INPUTS, ENVELOPES, THRESHOLDS, st.data())
def test_prandtl_ishlinskii_is_the_weighted_sum(v, envelope, r, data):
    weights = data.draw(arrays(float, len(r), elements=st.floats(-3, 3)))
    left, right = on(envelope, v)
    outputs = generalized_play(left, right, r)
    y = generalized_prandtl_ishlinskii(left, right, r, weights)
    np.testing.assert_allclose(y, outputs @ weights, rtol=1e-12, atol=1e-13)


def test_plays_of_an_input_are_those_on_its_envelopes():
    """Over several pieces, of which the last is short, and of one sample."""
    rng = np.random.default_rng(3)
    numbers = tuple(vars(PUBLISHED_ENVELOPE).values())
    r, weights = tuple(np.linspace(0, 0.9, 21)), tuple(rng.standard_normal(21))
    for count in (1, 255, 256, 900):
        v = np.cumsum(rng.standard_normal(count)) * 0.1
        sides = PUBLISHED_ENVELOPE.left(v), PUBLISHED_ENVELOPE.right(v)
        wanted = generalized_play(*sides, r) @ np.array(weights)
        found = enveloped_plays(v[::-1][::-1], numbers, r, weights)
        assert found == pytest.approx(wanted, abs=1e-12)


@given(INPUTS, ENVELOPES, st.integers(1, 60), st.data())
def test_rate_dependent_model_as_written(v, envelope, count, data):
    n = len(v)
    spacing = data.draw(arrays(float, n, elements=st.floats(0, 0.2)))
    ratio = data.draw(arrays(float, n, elements=st.floats(0, 1.1)))
    left, right = on(envelope, v)
    state, expected = np.zeros(count), np.empty(n)
    i = np.arange(count)
    for k in range(n):
        r = i * spacing[k]
        state = np.maximum(right[k] - r, np.minimum(left[k] + r, state))
        expected[k] = np.sum(ratio[k] ** i * state)
    y, end = rate_dependent_prandtl_ishlinskii(left, right, spacing, ratio, count)
    np.testing.assert_allclose(y, expected, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(end, state, rtol=1e-12, atol=1e-13)


def test_rate_dependent_model_of_constant_rate_is_the_plain_one():
    v = 0.6 * np.sin(np.linspace(0, 20, 300))
    left, right = on(PUBLISHED_ENVELOPE, v)
    r = 0.01 * np.arange(31)
    plain = generalized_prandtl_ishlinskii(left, right, r, 0.9 ** np.arange(31))
    spacing, ratio = np.full(300, 0.01), np.full(300, 0.9)
    y, _ = rate_dependent_prandtl_ishlinskii(left, right, spacing, ratio, 31)
    np.testing.assert_allclose(y, plain, rtol=1e-13, atol=1e-14)


# --- what makes them hysteresis operators


@given(INPUTS, ENVELOPES, THRESHOLDS, st.sampled_from(["eq4", "eq12"]), st.data())
def test_rate_independence(v, envelope, r, form, data):
    # a slower pass through the same values, each step cut and each value held
    repeats = data.draw(
        st.lists(st.integers(1, 3), min_size=len(v), max_size=len(v)), label="repeats"
    )
    slow = np.repeat(v, repeats)
    middle = (slow[1:] + slow[:-1]) / 2
    slower = np.insert(slow, np.arange(1, len(slow)), middle)
    fast = generalized_play(*sides(form, v, 0.0, *on(envelope, v)), r)
    held = sides(form, slower, 0.0, *on(envelope, slower))
    other = generalized_play(*held, r)
    last = 2 * (np.cumsum(repeats) - 1)
    np.testing.assert_array_equal(other[last], fast)


@given(INPUTS, VALUES, VALUES, ENVELOPES, THRESHOLDS, st.sampled_from(["eq4", "eq12"]))
def test_wiping_out(v, one, other, envelope, r, form):
    # an inner loop between the last two extremes leaves no trace
    low, high = v.min(), v.max()
    inner = np.clip([one, other, one, high], low, high)
    short = np.concatenate((v, [low, high]))
    long = np.concatenate((v, [low, high], inner))
    plain = generalized_play(*sides(form, short, v[0], *on(envelope, short)), r)
    looped = generalized_play(*sides(form, long, v[0], *on(envelope, long)), r)
    np.testing.assert_array_equal(looped[-1], plain[-1])


@given(INPUTS, ENVELOPES, THRESHOLDS, st.data())
def test_order_is_kept(v, envelope, r, data):
    # a greater input and a greater start never give a smaller output (Eq. 4)
    more = v + data.draw(arrays(float, len(v), elements=st.floats(0, 0.3)))
    start = data.draw(arrays(float, len(r), elements=st.floats(-1, 1)))
    less_out = generalized_play(*on(envelope, v), r, start)
    more_out = generalized_play(*on(envelope, more), r, start + 0.1)
    assert (more_out >= less_out).all()


@given(INPUTS, ENVELOPES, THRESHOLDS, st.floats(-2, 2))
def test_extremes_by_equations_7_and_8(v, envelope, r, start):
    # max F = f(at max v, w(0)) where w(0) is the first output, min F likewise
    left, right = on(envelope, v)
    outputs = generalized_play(left, right, r, np.full(len(r), start))
    first = outputs[0]
    np.testing.assert_array_equal(
        outputs.max(axis=0), np.maximum(right.max() - r, first)
    )
    np.testing.assert_array_equal(
        outputs.min(axis=0), np.minimum(left.min() + r, first)
    )


@given(INPUTS, ENVELOPES, THRESHOLDS)
def test_outputs_stay_between_the_envelopes(v, envelope, r):
    left, right = on(envelope, v)
    outputs = generalized_play(left, right, r)
    assert (outputs >= right[:, None] - r).all()
    assert (outputs <= left[:, None] + r).all()


@given(INPUTS, ENVELOPES, THRESHOLDS, VALUES, st.data())
def test_equations_4_and_12_agree_from_inside_the_band(v, envelope, r, before, data):
    share = data.draw(arrays(float, len(r), elements=st.floats(0, 1)))
    left, right = on(envelope, np.array([before]))
    low, high = right - r, left + r
    start = np.clip(low + share * (high - low), low, high)
    four = generalized_play(*on(envelope, v), r, start)
    moved = sides("eq12", v, before, *on(envelope, v))
    twelve = generalized_play(*moved, r, start)
    np.testing.assert_array_equal(four, twelve)


def test_equations_4_and_12_differ_at_the_start():
    # H = 0, x = 0, r = 0: gamma_r(0) = 0.3223 tanh(0.1104) - 0.0248 = 0.0106
    v = np.zeros(3)
    left, right = on(PUBLISHED_ENVELOPE, v)
    four = generalized_play(left, right, [0.0])
    twelve = generalized_play(*sides("eq12", v, 0.0, left, right), [0.0])
    assert four.ravel() == pytest.approx(np.full(3, 0.0106), abs=5e-5)
    assert not twelve.any()


def test_play_loop_by_hand():
    outputs = play([0, 1, 2, 1, 0, -1, 0], [0.5])
    assert outputs.ravel() == pytest.approx([0, 0.5, 1.5, 1.5, 0.5, -0.5, -0.5])


@given(INPUTS, ENVELOPES, THRESHOLDS, st.sampled_from(["eq4", "eq12"]), st.data())
def test_state_goes_on(v, envelope, r, form, data):
    cut = data.draw(st.integers(1, len(v)))
    left, right = on(envelope, v)
    left, right = sides(form, v, 0.0, left, right)
    whole = generalized_play(left, right, r)
    before = generalized_play(left[:cut], right[:cut], r)
    behind = generalized_play(left[cut:], right[cut:], r, before[-1])
    np.testing.assert_array_equal(np.concatenate([before, behind]), whole)


# --- linear dynamics


@given(st.integers(0, 20), st.integers(0, 2**32 - 1))
def test_state_space_as_written(size, seed):
    rng = np.random.default_rng(seed)
    a = rng.standard_normal((size, size)) / (size + 1)
    b, c, u = rng.standard_normal(size), rng.standard_normal(size), rng.random(40)
    x = np.zeros(size)
    expected = np.empty(40)
    for k in range(40):
        expected[k] = c @ x + 0.3 * u[k]
        x = a @ x + b * u[k]
    y = state_space(a, b, c, 0.3, u)
    np.testing.assert_allclose(y, expected, rtol=1e-10, atol=1e-11)


def test_state_space_step_of_a_first_order_lag():
    y = state_space([[0.5]], [0.5], [1.0], 0.0, np.ones(20))
    assert y == pytest.approx(1 - 0.5 ** np.arange(20))


# --- what is refused


@pytest.mark.parametrize(
    ("broken", "told"),
    [
        (lambda: generalized_play([1, 2], [1], [0]), "right: "),
        (lambda: generalized_play([[1]], [1], [0]), "left: 2 dimensions"),
        (lambda: generalized_play([1], [1], [-1]), "thresholds: a negative"),
        (lambda: generalized_play([1], [1], [np.nan]), "thresholds: a negative"),
        (lambda: generalized_play([1], [1], [0], [1, 2]), "state: "),
        (lambda: generalized_prandtl_ishlinskii([1], [1], [0], [1, 2]), "weights: "),
        (
            lambda: rate_dependent_prandtl_ishlinskii([1], [1], [-1], [1], 3),
            "spacing: a negative",
        ),
        (
            lambda: rate_dependent_prandtl_ishlinskii([1], [1], [1], [1, 2], 3),
            "ratio: ",
        ),
        (
            lambda: rate_dependent_prandtl_ishlinskii([1], [1], [1], [1], 0),
            "count: 0",
        ),
        (lambda: state_space(np.eye(2), [1], [1], 0.0, [1]), "do not fit"),
    ],
)
def test_what_does_not_fit_is_refused(broken, told):
    with pytest.raises(InputError, match=told):
        broken()


def modes(factors, b, c, d, u, x0):
    y = np.empty(len(u))
    padded = [kernels.pad(values) for values in (factors, b, c)]
    vectors = len(padded[0]) // kernels.WIDTH
    kernels.call("hb_modes", len(u), vectors, *padded, d, u, kernels.pad(x0), y)
    return y


@pytest.mark.parametrize("size", [1, 7, 8, 9, 24, 50, 70])
def test_modes_are_a_diagonal_state_space(size):
    rng = np.random.default_rng(size)
    factors, b, c, x0 = rng.uniform(-0.99, 0.99, (4, size))
    u = rng.normal(size=200)
    expected = operators.state_space(np.diag(factors), b, c, 0.3, u)
    begun = factors ** np.arange(200)[:, None] @ (c * x0)
    found = modes(factors, b, c, 0.3, u, x0)
    np.testing.assert_allclose(found, expected + begun, rtol=0, atol=1e-11)


@pytest.mark.parametrize("count", [1, 8, 9, 31, 60])
def test_growing_thresholds_are_the_plays_of_each_moment(count):
    # A growth that rests for a while is a model of those thresholds, carried on.
    rng = np.random.default_rng(count)
    left, right = rng.normal(1, 1, 300), rng.normal(-1, 1, 300)
    r, w = rng.uniform(0, 1, count), rng.normal(size=count)
    growth = np.repeat([1.0, 2.5, 0.0], 100)
    state, expected = None, []
    for part in (slice(0, 100), slice(100, 200), slice(200, 300)):
        plays = operators.generalized_play(
            left[part], right[part], growth[part][0] * r, state
        )
        state = plays[-1]
        expected.append(plays @ w)
    found = operators.generalized_prandtl_ishlinskii(left, right, r, w, growth)
    np.testing.assert_allclose(found, np.concatenate(expected), rtol=0, atol=1e-12)
