"""How a grid is looked at: no valley is too narrow, and what is refused is skipped."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.errors import InputError
from hystbench.gap.effects.effect import Declined
from hystbench.gap.fitting.variant_search import Trial
from tests.gap.small import coarse


def attempt(axes, score):
    """A variant whose score at a point is a plain function; what was asked for it."""
    variant = SimpleNamespace(grids={str(k): np.array(a) for k, a in enumerate(axes)})
    asked = []

    def at(point):
        if point not in asked:
            asked.append(point)
        return Trial(one, {}, score(*point))

    one = SimpleNamespace(variant=variant, at=at)
    return one, asked


@given(st.integers(1, 25), st.integers(0, 24))
def test_of_one_number_no_valley_is_too_narrow(size, valley):
    valley %= size
    one, asked = attempt([range(size)], lambda x: -1.0 if x == valley else float(x))
    assert coarse(one).score == -1.0
    assert len(asked) == size


@given(st.integers(1, 20), st.integers(1, 6), st.data())
def test_of_two_numbers_a_slanted_valley_is_followed(size, other, data):
    """Its place over the first moves with the second; lines fall towards it."""
    long, short = max(size, other), min(size, other)
    place = data.draw(st.integers(0, size - 1))
    rest = data.draw(st.integers(0, other - 1))
    slant = data.draw(st.sampled_from([-1, 0, 1]))

    def score(x, y):
        return 10.0 * abs(x - place - slant * (y - rest)) + abs(y - rest)

    one, asked = attempt([range(size), range(other)], score)
    assert coarse(one).score == min(
        score(x, y) for x in range(size) for y in range(other)
    )
    # A line's own lowest place, one on each side of it and what is walked.
    assert len(asked) <= (long + 4 * (short - 1) if short > 2 else size * other)


@pytest.mark.parametrize("only", [(4, 0), (4, 5), (0, 5)])
@pytest.mark.parametrize("runs_away", [False, True])
def test_a_grid_that_is_refused_nearly_everywhere_is_tried_whole(only, runs_away):
    def score(x, y):
        if (x, y) != only:
            if runs_away:
                return np.inf
            raise InputError("refused")
        return 3.0

    one, _ = attempt([range(5), range(6)], score)
    assert coarse(one).score == 3.0


def test_a_grid_that_is_refused_everywhere_declines_with_the_reason():
    def score(x, y):
        raise InputError(f"{x} and {y} are refused")

    one, _ = attempt([range(5), range(6)], score)
    with pytest.raises(Declined, match="are refused"):
        coarse(one)


def test_without_a_number_to_search_there_is_one_point():
    one, asked = attempt([], lambda: 2.0)
    assert coarse(one).score == 2.0
    assert asked == [()]
