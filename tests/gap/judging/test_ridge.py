import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.gap.judging.ridge import Moments


@given(st.integers(0, 1000), st.integers(20, 60), st.integers(1, 6))
def test_weights_are_those_of_the_stacked_least_squares(seed, rows, columns):
    random = np.random.default_rng(seed)
    table = random.standard_normal((rows, columns))
    target = random.standard_normal(rows)
    train = random.random((3, rows)) < 0.7
    penalties = [10 ** random.uniform(-4, 1, columns) for _ in range(2)]
    moments = Moments.of(table, target, train)
    for fold in (None, 0, 1, 2):
        used = np.ones(rows, dtype=bool) if fold is None else train[fold]
        for found, penalty in zip(
            moments.solve(fold, penalties), penalties, strict=True
        ):
            # ridge as plain least squares with one more row a column
            extra = np.diag(np.sqrt(used.sum() * penalty))
            expected, *_ = np.linalg.lstsq(
                np.vstack([table[used], extra]),
                np.concatenate([target[used], np.zeros(columns)]),
            )
            assert found == pytest.approx(expected, rel=1e-6, abs=1e-9)
