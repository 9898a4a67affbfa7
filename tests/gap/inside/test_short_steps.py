"""Numbers that short steps of a simulation move."""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from hystbench.gap.inside import short_steps
from hystbench.gap.inside.short_steps import in_short_steps
from hystbench.gap.thresholds import PAYS

FREE = tuple(SimpleNamespace(low=-np.inf, high=np.inf) for _ in range(2))


@dataclass(frozen=True)
class Moving:
    """A model of two numbers; by short steps it is off below a first one of 2.001."""

    numbers: tuple[float, float] = (2.0, 5.0)
    short: bool = False
    free = FREE

    def value(self, free):
        return self.numbers[self.free.index(free)]

    def at(self, numbers):
        return replace(self, numbers=tuple(numbers[k] for k in range(2)), short=False)

    def settled(self):
        return replace(self, short=True)


@pytest.fixture
def looked(monkeypatch):
    def score_of(state, jump):
        first, second = state.numbers
        other = jump if state.short and first < 2.001 else 0.0
        return other + 1e8 * ((first - 2.002) ** 2 + (second - 5.0) ** 2)

    moved = []

    def moves(state, jump):
        moved.append(state)
        return of_the_same_motion(state, jump)

    of_the_same_motion = short_steps.of_the_same_motion
    monkeypatch.setattr(short_steps, "score_of", score_of)
    monkeypatch.setattr(short_steps, "of_the_same_motion", moves)
    monkeypatch.setattr(short_steps, "fitted", lambda s, *_: SimpleNamespace(state=s))
    return moved


def test_where_short_steps_take_another_motion_numbers_move_to_the_right_one(looked):
    found = in_short_steps(Moving(), 1e4)
    assert len(looked) == 1
    assert found.numbers == pytest.approx((2.002, 5.0), abs=5e-4)
    assert found.short


def test_numbers_stay_where_short_steps_do_as_well(looked):
    found = in_short_steps(Moving(), PAYS / 2)
    assert looked == []
    assert found == Moving(short=True)
