"""The play operator of the examples is that of its definition."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.gap.examples import plain_play, widened_play

SIGNALS = st.lists(st.floats(-5, 5), min_size=1, max_size=70).map(np.array)


def sample_by_sample(u, half_widths):
    state, out = 0.0, []
    for value, half in zip(u, half_widths, strict=True):
        state = max(value - half, min(value + half, state))
        out.append(state)
    return np.array(out)


@given(SIGNALS, st.floats(0, 3))
def test_the_play_operator_is_its_recursion(u, half):
    assert (plain_play(u, half) == sample_by_sample(u, np.full(len(u), half))).all()


@given(SIGNALS, st.floats(0, 3), st.integers(0, 2**32 - 1))
def test_so_is_the_one_that_widens(u, half, seed):
    widen = 1 + np.random.default_rng(seed).random(len(u))
    expected = sample_by_sample(u, half * widen)
    assert widened_play(u, half, widen) == pytest.approx(expected, abs=1e-12)
