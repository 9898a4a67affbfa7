"""Algorithm 1 against plain NumPy and against what defines its parts."""

import json
from functools import cache

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from hystbench.envelope import PUBLISHED_ENVELOPE, Envelope, thresholds
from hystbench.errors import InputError
from hystbench.identification import fit_weights, identify, shape
from hystbench.identification.search import Search
from hystbench.identification.weights import (
    Samples,
    reduced,
    solve,
    turning_points,
)

AMPLITUDE, ORDER = 0.632, 8


def plain_gpi(u, envelope, r, weights, state=None):
    """Eqs. 4 to 6 and 9, written out; returns the output and the states."""
    e = envelope
    left = e.a0 * np.tanh(e.a1 * u + e.a2) + e.a3
    right = e.a4 * np.tanh(e.a5 * u + e.a6) + e.a7
    state = np.zeros(len(r)) if state is None else state
    y = np.empty(len(u))
    for k in range(len(u)):
        state = np.maximum(right[k] - r, np.minimum(left[k] + r, state))
        y[k] = weights @ state
    return y, state


def slow_sine(samples=1500):
    return AMPLITUDE * np.sin(2 * np.pi * np.arange(samples) / samples)


def plant():
    r = np.arange(ORDER + 1) / (ORDER + 1) * 0.21
    return PUBLISHED_ENVELOPE, r, 40.0 * np.exp(-0.6 * np.arange(ORDER + 1))


@pytest.fixture(scope="module")
def record():
    u = slow_sine()
    return u, plain_gpi(u, *plant())[0]


@pytest.fixture(scope="module")
def found(record):
    return identify(*record, ORDER, epsilon=0.0, starts=3)


boxes = st.builds(
    lambda shares: shape.LOWER + np.array(shares) * (shape.UPPER - shape.LOWER),
    st.lists(st.floats(0, 1), min_size=7, max_size=7),
)


@given(boxes, st.floats(-5, 5), st.floats(0.01, 10))
def test_every_point_of_the_box_gives_feasible_envelopes(point, low, width):
    envelope = shape.envelope_of(point, low, low + width)
    u = np.linspace(low, low + width, 4001)
    left, right = envelope.left(u), envelope.right(u)
    rounding = 1e-12 * max(abs(envelope.a0), abs(envelope.a4))
    assert (np.diff(left) >= -rounding).all()
    assert (np.diff(right) >= -rounding).all()
    assert right[-1] - right[0] == pytest.approx(1.0, rel=1e-6)
    assert np.min(left - right) > 0
    assert np.min(left - right) == pytest.approx(point[5], rel=0.05, abs=1e-4)


@given(st.lists(st.integers(-4, 4), min_size=20, max_size=200), st.integers(2, 12))
def test_a_thinned_record_leaves_the_operators_as_they_were(steps, count):
    u = np.cumsum(np.array(steps, dtype=float))
    assume(np.ptp(u) > 0)
    where = np.arange(len(u), dtype=float)
    r = np.array([0.0, 0.7, 2.0])
    envelope = Envelope(2.0, 0.3, 0.2, 0.5, 2.0, 0.3, 0.1, 0.0)
    kept_u, kept = reduced(u, where, count)
    thinned = Samples(kept_u, kept_u, u[:0]).outputs(envelope, r)
    whole = Samples(u, u, u[:0]).outputs(envelope, r)
    assert np.array_equal(thinned, whole[kept.astype(int)])
    assert len(kept) <= count + len(turning_points(u))


def test_turning_points_are_the_ends_and_the_reversals():
    u = np.array([0.0, 1.0, 2.0, 2.0, 1.0, 1.0, 0.5, 3.0, 4.0])
    kept = u[turning_points(u)]
    assert list(kept) == [0.0, 2.0, 0.5, 4.0]


@given(st.integers(0, 10_000), st.booleans())
def test_weights_meet_the_conditions_of_a_constrained_minimum(seed, with_offset):
    random = np.random.default_rng(seed)
    outputs = random.normal(size=(60, 6)) + random.normal(size=6)
    y = random.normal(size=60) + 3.0 * random.normal()
    weights, offset = solve(outputs, y, with_offset)
    gradient = outputs.T @ (outputs @ weights + offset - y)
    size = np.linalg.norm(outputs, axis=0) * np.linalg.norm(y)
    assert (weights >= 0).all()
    assert (gradient >= -1e-8 * size).all()
    assert np.abs(gradient[weights > 0] / size[weights > 0]).max(initial=0) < 1e-8
    if with_offset:
        assert np.sum(outputs @ weights + offset - y) == pytest.approx(0, abs=1e-8)
    else:
        assert offset == 0


def test_operators_that_never_move_do_no_harm_beside_an_offset():
    u = np.linspace(0, 1, 50)
    outputs = np.column_stack([u, np.full(50, 0.1), np.full(50, 1 / 3)])
    weights, offset = solve(outputs, 2 * u - 7, with_offset=True)
    assert outputs @ weights + offset == pytest.approx(2 * u - 7, abs=1e-6)


@settings(max_examples=20)
@given(boxes)
def test_the_jacobian_gives_the_slope_of_the_best_cost(point):
    u = slow_sine(300)
    y = plain_gpi(u, *plant())[0]
    search = Search(Samples(u, y, u[:0]), ORDER, 0.0, 1)
    samples = search._thinned("rest", len(u))
    point = np.clip(point, shape.LOWER + 1e-3, shape.UPPER - 1e-3)
    fit = search._fit(samples, point)
    slope = 2 * search._jacobian(samples, fit).T @ fit.error
    for k in range(len(point)):
        # Where a weight becomes zero the cost has a corner: the slope is one side's.
        sides = []
        for step in (1e-5, -1e-5):
            beside = point.copy()
            beside[k] += step
            sides.append((search._fit(samples, beside).cost - fit.cost) / step)
        sides.append(sum(sides) / 2)  # where the cost is bent, the slope is their mean
        near = pytest.approx(slope[k], rel=0.05, abs=1e-4 * fit.cost)
        assert any(side == near for side in sides), sides


def test_the_loop_of_an_independent_plant_is_recovered(found, record):
    u, y = record
    assert found.relative_error < 1e-3
    assert found.simulate(u) == pytest.approx(y, abs=2e-3 * np.abs(y).max())


def test_minor_loops_it_never_saw_are_recovered(found):
    t = np.arange(3000) / 1000
    u = AMPLITUDE * np.exp(-0.6 * t) * np.sin(2 * np.pi * 2 * t)
    y = plain_gpi(u, *plant())[0]
    error = found.simulate(u) - y
    assert np.sqrt(np.mean(error**2) / np.mean(y**2)) < 0.01


def test_envelopes_match_the_plants_up_to_scale(found):
    v = np.linspace(-AMPLITUDE, AMPLITUDE, 101)

    def curves(envelope):
        both = np.concatenate([envelope.left(v), envelope.right(v)])
        return both / np.abs(both).max()

    assert curves(found.envelope) == pytest.approx(curves(PUBLISHED_ENVELOPE), abs=0.02)


def test_the_result_keeps_the_rules_of_the_model(found, record):
    u, y = record
    v = np.linspace(u.min(), u.max(), 2001)
    assert (found.envelope.left(v) > found.envelope.right(v)).all()
    assert found.envelope.a0 * found.envelope.a1 > 0
    assert found.envelope.a4 * found.envelope.a5 > 0
    assert (found.weights >= 0).all()
    assert found.thresholds == pytest.approx(
        thresholds(found.envelope, np.abs(u).max(), ORDER)
    )
    again, _ = plain_gpi(u, found.envelope, found.thresholds, found.weights)
    assert found.cost == pytest.approx(np.sum((again - y) ** 2), rel=1e-6)


def test_the_scale_is_the_callers_and_changes_no_loop(found, record):
    u, y = record
    largest = shape.envelope_scale(found.envelope, u.min(), u.max())
    assert largest == pytest.approx(AMPLITUDE)
    other = identify(u, y, ORDER, epsilon=0.0, starts=3, scale=0.2)
    assert shape.envelope_scale(other.envelope, u.min(), u.max()) == pytest.approx(0.2)
    assert other.simulate(u) == pytest.approx(found.simulate(u), abs=1e-6)


def test_the_least_j_never_rises_and_progress_sees_it(record):
    seen = []
    result = identify(
        *record, ORDER, epsilon=0.0, starts=2, progress=lambda k, j: seen.append((k, j))
    )
    assert [j for _, j in seen] == list(result.cost_history)
    assert [k for k, _ in seen] == list(range(1, len(seen) + 1))
    assert (np.diff(result.cost_history) <= 0).all()
    assert result.cost_history[-1] == pytest.approx(result.cost, rel=1e-6)


def test_an_epsilon_out_of_reach_is_told_clearly(record):
    u, y = record
    noisy = y + 0.5 * np.random.default_rng(1).standard_normal(len(y))
    result = identify(u, noisy, ORDER, epsilon=1e-3, starts=2)
    assert not result.reached
    assert result.message.startswith("epsilon not reached: J = ")
    assert f"after {len(result.cost_history)} iterations" in result.message
    assert "epsilon = 0.001" in result.message
    assert "the best is kept" in result.message
    # no envelope can explain the noise, and none should leave more than it
    assert result.cost == pytest.approx(0.25 * len(y), rel=0.15)


def test_it_ends_as_soon_as_epsilon_is_reached(record):
    u, y = record
    easy = identify(u, y, ORDER, epsilon=0.01 * float(np.sum(y**2)))
    assert easy.reached
    assert easy.message.startswith("epsilon reached")
    assert easy.cost < easy.epsilon
    assert all(j >= easy.epsilon for j in easy.cost_history[:-1])


def test_the_number_of_iterations_is_kept(record):
    result = identify(*record, ORDER, epsilon=0.0, max_iterations=5)
    assert len(result.cost_history) == 5


def test_the_same_seed_gives_the_same_answer(record):
    one = identify(*record, ORDER, epsilon=0.0, starts=3, seed=4)
    two = identify(*record, ORDER, epsilon=0.0, starts=3, seed=4)
    assert one.to_dict() == two.to_dict()


@cache
def in_plain_units():
    """Give a record, and what is found in it."""
    u = slow_sine(400)
    y = plain_gpi(u, *plant())[0]
    return u, y, identify(u, y, ORDER, starts=1, epsilon=0.0)


@settings(max_examples=8)
@given(st.floats(1e-4, 1e5), st.floats(1e-4, 1e5))
def test_units_change_nothing(unit_u, unit_y):
    u, y, one = in_plain_units()
    other = identify(unit_u * u, unit_y * y, ORDER, starts=1, epsilon=0.0)
    assert other.relative_error == pytest.approx(one.relative_error, rel=0.1, abs=1e-4)


@pytest.mark.parametrize("shift", [100.0, -100.0])
def test_a_large_static_offset_is_fitted_beside_eq_9(record, shift):
    u, y = record
    result = identify(u, y + shift, ORDER, starts=3, epsilon=0.0)
    assert np.sum((result.simulate(u) - y - shift) ** 2) < 1e-5 * np.sum(y**2)
    assert (result.weights >= 0).all()


def test_no_offset_is_fitted_where_eq_9_can_do_without(found):
    assert found.offset == 0.0


def test_a_record_that_starts_in_the_middle_of_a_branch(record):
    u, _ = record
    envelope, r, weights = plant()
    _, state = plain_gpi(u, envelope, r, weights)
    middle = np.roll(u, 700)
    _, state = plain_gpi(middle, envelope, r, weights, state)
    y, _ = plain_gpi(middle, envelope, r, weights, state)
    result = identify(middle, y, ORDER, epsilon=0.0, starts=2)
    assert result.start == "settled"
    assert result.relative_error < 2e-3
    rest = identify(middle, y, ORDER, epsilon=0.0, starts=2, start="rest")
    assert rest.relative_error > 5 * result.relative_error


def test_a_clockwise_loop_gets_weights_of_either_sign():
    u = np.tile(slow_sine(600), 2)
    plays, _ = plain_gpi(u, Envelope(1, 1, 0, 0, 1, 1, 0, 0), np.array([0.3]), [1.0])
    y = np.tanh(u) - plays  # what a stop operator gives: it leads
    result = identify(u, y, ORDER, epsilon=0.0, starts=3)
    assert result.relative_error < 0.05
    bound = identify(u, y, ORDER, epsilon=0.0, starts=3, nonnegative=True)
    assert (bound.weights >= 0).all()
    assert bound.relative_error > 5 * result.relative_error


def test_published_envelopes_are_compared_with_weights_of_their_own(record):
    u, y = record
    other = Envelope(0.3, 1.0, 0.0, 0.05, 0.3, 1.0, 0.0, 0.0)
    result = identify(u, y, ORDER, starts=1, published=other)
    alone = fit_weights(u, y, other, ORDER)
    assert result.published_relative_error == pytest.approx(alone.relative_error)
    output, _ = plain_gpi(u, other, alone.thresholds, alone.weights)
    error = np.sqrt(np.sum((output - y) ** 2) / np.sum(y**2))
    assert alone.relative_error == pytest.approx(error, rel=1e-9)


def test_the_result_is_json_with_the_keys_that_others_read(found):
    told = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert set(told["envelope"]) == {f"a{j}" for j in range(8)}
    assert len(told["thresholds"]) == len(told["weights"]) == ORDER + 1
    assert told["J"][-1] == pytest.approx(told["J_final"], rel=1e-6)
    assert told["reached"] is False
    assert told["published_relative_error"] is None


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda u, y: (np.ones_like(u), y), "u is constant"),
        (lambda u, y: (u, np.zeros_like(y)), "y is constant"),
        (lambda u, y: (u, np.where(u > 0.6, np.nan, y)), "y is not finite"),
        (lambda u, y: (u[:-1], y), "must match"),
        (lambda u, y: (u[:20], y[:20]), "20 samples, expected at least 26"),
    ],
)
def test_a_record_that_cannot_serve_is_refused(record, change, message):
    with pytest.raises(InputError, match=message):
        identify(*change(*record), ORDER)


@pytest.mark.parametrize(
    "bad", [{"order": -1}, {"starts": 0}, {"max_iterations": 0}, {"scale": 0.0}]
)
def test_settings_that_make_no_sense_are_refused(record, bad):
    with pytest.raises(InputError, match=next(iter(bad))):
        identify(*record, **{"order": ORDER, **bad})
