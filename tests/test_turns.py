"""Where a signal turns back."""

import numpy as np

from hystbench.turns import turning_places


def test_turns_that_are_smaller_than_asked_are_none():
    u = np.array([0.0, 1.0, 0.95, 2.0, 0.5, 0.55, 0.0, 3.0])
    assert [0, *turning_places(u, 0.2), 7] == [0, 3, 6, 7]
