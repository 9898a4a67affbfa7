"""A race of starts, and which set of effects the others are exchanged in."""

from types import SimpleNamespace

import pytest

from hystbench.gap.fitting.least_squares import Fitted
from hystbench.gap.inside import race
from hystbench.gap.inside.choose import with_a_way
from hystbench.gap.inside.combine_forces import best_that_pays
from hystbench.gap.thresholds import FURTHER, SCALE


def start(score, *effects, form="", freedom=1.0):
    added = tuple(SimpleNamespace(effect=name, form=form) for name in effects)
    return Fitted(SimpleNamespace(added=added, freedom=freedom, sample=[0]), score)


@pytest.fixture
def rounds(monkeypatch):
    """Count the starts of each round, which a fit leaves where they are."""
    counted: dict[int, int] = {}

    def fitted(state, score, evaluations):
        counted[evaluations] = counted.get(evaluations, 0) + 1
        return Fitted(state, state.score)

    monkeypatch.setattr(race, "fitted", fitted)
    return counted


def running(*items):
    for item in items:
        item.state.score = item.score
    return sorted(((x, x) for x in items), key=lambda pair: pair[1].score)


def test_starts_of_one_law_that_came_to_one_place_go_on_as_one(rounds):
    alike = [start(100.0 + k / 100, "friction", form="dry") for k in range(8)]
    race.raced(running(*alike), None, 4, 32)
    assert rounds == {8: 4, 16: 2, 32: 1}


def test_a_law_that_cannot_be_told_from_the_best_stays_to_the_end(rounds):
    best = [start(100.0 + k / 100, "friction", form="dry") for k in range(4)]
    near = start(100.0 + SCALE / 2, "friction", form="LuGre", freedom=0.0)
    item, _ = race.raced(running(*best, near), None, 4, 32)
    assert item is near  # of a tie the one of fewer numbers
    assert rounds == {8: 4, 16: 3, 32: 3}


def test_a_law_that_is_worse_has_one_round_more(rounds):
    best = [start(100.0 + k, "friction", form="dry") for k in range(2)]
    worse = start(900.0, "friction", form="LuGre")
    item, _ = race.raced(running(*best, worse), None, 4, 16)
    assert item is best[0]
    assert rounds == {8: 3, 16: 2}


def test_others_are_put_in_the_place_of_effects_of_a_set_that_pays():
    single, pair = start(-500.0, "friction"), start(-900.0, "friction", "stop")
    three = start(-900.0 - FURTHER / 2, "friction", "stop", "drag")
    every = [start(0.0), single, pair, three]
    assert best_that_pays(every) is pair
    assert best_that_pays([start(0.0), single]) is single
    far = start(-901.0 - FURTHER, "friction", "stop", "drag")
    assert best_that_pays([*every, far]) is far


def test_a_set_without_one_of_one_effect_less_is_left_out():
    """How the effects were found is told one after the other."""
    alone, single = start(0.0), start(-500.0, "friction")
    pair, apart = start(-900.0, "friction", "stop"), start(-950.0, "drag", "gravity")
    three = start(-999.0, "drag", "gravity", "stop")
    assert with_a_way([three, pair, alone, apart, single]) == [pair, alone, single]
