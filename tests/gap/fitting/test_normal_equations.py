"""Normal equations that tell nothing: no step is taken."""

import numpy as np
import pytest

from hystbench.gap.fitting.normal_equations import solve


@pytest.mark.parametrize("wrong", [np.nan, np.inf])
@pytest.mark.parametrize("positive", [(), (0,)])
def test_what_is_not_finite_moves_nothing(wrong, positive):
    """LAPACK would end the search with an error that says nothing of its cause."""
    matrix = np.array([[2.0, wrong], [wrong, 3.0]])
    np.testing.assert_array_equal(solve(matrix, np.ones(2), positive), [0.0, 0.0])


def test_a_direction_that_two_columns_share_is_halved():
    matrix = np.array([[1.0, 1.0], [1.0, 1.0]])
    np.testing.assert_allclose(solve(matrix, np.array([2.0, 2.0]), ()), [1.0, 1.0])
