"""Steps within bounds end where other solvers do, and a descent says what it did."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import lsq_linear

from hystbench.bounded_least_squares import (
    LeastSquaresPoint,
    damped_step,
    descend,
    minimize,
)

WIDE = np.full(3, 1e6)


def linear_problem(seed: int):
    random = np.random.default_rng(seed)
    return random.normal(size=(12, 3)), random.normal(size=12)


@given(st.integers(0, 10_000))
def test_an_undamped_step_solves_a_linear_problem(seed):
    a, b = linear_problem(seed)
    start = np.zeros(3)
    found = damped_step(a, a @ start - b, start, -WIDE, WIDE, damping=0.0)
    assert found == pytest.approx(np.linalg.lstsq(a, b, rcond=None)[0], rel=1e-6)


@given(st.integers(0, 10_000))
def test_the_minimum_within_bounds_is_that_of_another_solver(seed):
    a, b = linear_problem(seed)
    lower, upper = np.full(3, -0.1), np.full(3, 0.2)
    point, cost = minimize(lambda x: a @ x - b, np.zeros(3), lower, upper)
    assert ((lower <= point) & (point <= upper)).all()
    expected = lsq_linear(a, b, (lower, upper), tol=1e-12)
    assert cost == pytest.approx(2 * expected.cost, rel=1e-5)


def test_a_curved_valley_is_followed_to_its_end():
    def rosenbrock(x):
        return np.array([10 * (x[1] - x[0] ** 2), 1 - x[0]])

    point, cost = minimize(
        rosenbrock, np.array([-1.2, 1.0]), -np.full(2, 5.0), np.full(2, 5.0)
    )
    assert point == pytest.approx([1.0, 1.0], abs=1e-3)
    assert cost < 1e-8


def test_a_point_whose_error_is_not_finite_is_never_taken():
    def error(x):
        return np.array([np.sqrt(x[0]) - 3.0]) if x[0] < 4 else np.array([np.inf])

    point, cost = minimize(error, np.array([1.0]), np.array([0.1]), np.array([9.0]))
    assert point[0] < 4
    assert np.isfinite(cost)


def test_a_descent_tells_each_step_and_last_the_one_that_wins_nothing():
    a, b = linear_problem(1)

    def at(point):
        return LeastSquaresPoint(point, a @ point - b)

    start = at(np.zeros(3))
    told = list(descend(start, at, lambda _: a, -WIDE, WIDE, least_gain=0.0))
    costs = [start.cost, *(step.cost for step in told)]
    assert len(told) > 2
    assert all(after < before for before, after in pairwise(costs[:-1]))
    assert told[-1] is told[-2]
