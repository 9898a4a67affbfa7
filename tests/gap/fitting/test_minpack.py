"""Least squares that end at the same digits, whatever lies in memory."""

import numpy as np
import pytest

from hystbench.gap.fitting.minpack import least_squares_point

COUNT, ROWS = 17, 400
TIME = np.linspace(0.0, 1.0, ROWS)
COLUMNS = np.column_stack([np.exp(-TIME * (1 + 0.02 * k)) for k in range(COUNT)])


def found(wanted, kept):
    """Fit exponentials that hardly differ, which takes many steps; keep them all."""

    def residual(x):
        rest = np.add.reduce(COLUMNS * (x + 0.1 * x**2), axis=1) - wanted
        kept.append((x.tobytes(), rest.tobytes()))
        return rest

    def slopes(x):
        own = COLUMNS * (1.0 + 0.2 * x)
        kept.append((x.tobytes(), own.tobytes()))
        return own

    about = {"scale": 3.0, "evaluations": 30, "enough": 1e-10}
    return least_squares_point(residual, slopes, COUNT, **about)


def test_a_fit_of_numbers_that_hardly_differ_ends_at_the_same_digits():
    """What is kept and freed meanwhile is what MINPACK would read behind a column."""
    random = np.random.default_rng(0)
    wanted = COLUMNS @ random.standard_normal(COUNT)
    wanted += 1e-3 * random.standard_normal(ROWS)
    points = set()
    for _ in range(200):
        freed = [np.zeros(size) for size in random.integers(100, 40_000, 5)]
        del freed
        kept = [random.random(size) for size in random.integers(10, 3000, 20)]
        points.add(found(wanted, kept).tobytes())
    assert len(points) == 1


def test_the_point_is_that_of_the_normal_equations():
    some = np.column_stack([np.cos(7 * TIME), TIME, TIME**2])
    wanted = some @ [1.0, -2.0, 0.5] + 0.01 * np.cos(20 * TIME)
    point = least_squares_point(
        lambda x: some @ x - wanted,
        lambda x: some,
        some.shape[1],
        scale=0.01,
        evaluations=50,
        enough=1e-12,
    )
    expected = np.linalg.lstsq(some, wanted, rcond=None)[0]
    assert point == pytest.approx(expected, rel=1e-6)
