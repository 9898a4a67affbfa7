"""Which hosts forces are tried in, and when several are."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from hystbench.gap.fitting.least_squares import Fitted
from hystbench.gap.inside import try_hosts
from hystbench.gap.inside.combine_forces import ForceSearch
from hystbench.gap.inside.try_hosts import (
    HostTrial,
    Tried,
    best_with_several,
    in_each_host,
)

LEAST = -1000.0


def hypothesis(score, left, *effects):
    added = tuple(SimpleNamespace(effect=name, form="") for name in effects)
    state = SimpleNamespace(added=added, freedom=0.0, power=lambda floor: left)
    return Fitted(state, score)


def host(counts=0, kind="coordinate"):
    about = {
        "words": "",
        "fitted": None,
        "unfitted_start": None,
        "charge": 0.0,
        "carry": None,
    }
    return SimpleNamespace(counts=counts, kind=kind, **about)


@pytest.fixture
def trial():
    start = SimpleNamespace(power=lambda floor: 1.0)
    score = SimpleNamespace(floor=0.0, least=lambda freedom: LEAST)
    return HostTrial(start, ForceSearch(lambda _: {}, score), 0.01, True)


def offering(trial, laws):
    return replace(trial, forces=replace(trial.forces, offer=lambda _: laws))


@pytest.mark.parametrize(
    ("score", "left", "identified", "wanted"),
    [
        (-500.0, 0.2, True, True),
        (-500.0, 0.005, True, False),  # it may stay unnamed
        (-500.0, 0.005, False, True),  # beside known numbers it may stand for others
        (LEAST + 50.0, 0.2, True, False),  # no further effect could gain enough
    ],
)
def test_several_are_tried_where_they_could_matter(
    trial, score, left, identified, wanted
):
    best = hypothesis(score, left, "friction")
    asked = replace(trial, identified=identified)
    assert asked.wants_more(Tried(host(), [best], best)) == wanted


def tried_in(trial, monkeypatch, lefts, most, hosts=None, begins_again=lambda _: False):
    rest = iter(lefts)

    def singles(*_):
        left = next(rest)
        return [hypothesis(0.0, 1.0), hypothesis(-900.0 * (1 - left), left, "friction")]

    asked = []

    def limit():
        asked.append(True)
        return most

    monkeypatch.setattr(ForceSearch, "singles", singles)
    monkeypatch.setattr(try_hosts, "chosen", lambda found, *_: found[-1])
    hosts = [host() for _ in lefts] if hosts is None else hosts
    found = in_each_host(trial, hosts, limit, begins_again)
    return found and (len(found[0]), found[1]), len(asked)


def test_a_chain_is_not_searched_where_the_first_host_leaves_little(trial, monkeypatch):
    found, asked = tried_in(trial, monkeypatch, [0.005, 0.3], 7)
    assert (found, asked) == ((2, float("inf")), 0)


def test_a_chain_says_how_many_effects_there_are_at_most(trial, monkeypatch):
    found, asked = tried_in(trial, monkeypatch, [0.3, 0.3], 7)
    assert found == (2, 7)
    assert asked > 0


def test_no_host_is_tried_where_a_chain_leaves_nothing(trial, monkeypatch):
    given = replace(trial, identified=False)
    assert tried_in(given, monkeypatch, [0.3], 0)[0] is None
    known = [host(counts=1)]
    assert tried_in(given, monkeypatch, [0.3], 1, known)[0] is None


def test_a_search_ends_where_it_is_to_begin_again(trial, monkeypatch):
    told = []

    def again(tried):
        told.append(tried.best.effects)
        return True

    lefts = [0.3, 0.3]
    assert tried_in(trial, monkeypatch, lefts, 7, begins_again=again)[0] is None
    assert told == [("friction",)]
    told.clear()
    tried_in(trial, monkeypatch, [0.8, 0.8], 7, begins_again=again)
    assert told == []  # it takes less than half of the gap


@pytest.mark.parametrize(("left", "tried"), [(0.005, 2), (0.3, 3)])
def test_no_host_of_many_modes_is_tried_where_little_is_left(
    trial, monkeypatch, left, tried
):
    hosts = [host(), host(kind="structure"), host()]
    found, _ = tried_in(trial, monkeypatch, [left, 0.3, 0.3], 7, hosts)
    assert found[0] == tried


def test_in_a_host_with_a_timing_the_best_force_is_tried_and_others_are_fitted_on(
    trial, monkeypatch
):
    asked = []

    def singles(self, host, *_):
        asked.append(set(self.offer(host)))
        return [host, hypothesis(-800.0, 0.2, *self.offer(host))]

    def to_the_end(begun, *_):
        return [Fitted(item.state, item.score - 10.0) for item in begun]

    monkeypatch.setattr(ForceSearch, "singles", singles)
    monkeypatch.setattr(try_hosts, "to_the_end", to_the_end)
    monkeypatch.setattr(try_hosts, "gentlest", lambda state: ())
    monkeypatch.setattr(try_hosts, "chosen", lambda found, *_: found[-1])
    late = SimpleNamespace(**vars(host()) | {"fitted": hypothesis(-1.0, 1.0)})
    late.carry = lambda state: state
    forces = {"friction": [], "drag": [], "gravity": []}
    told = offering(trial, forces)
    found = [
        hypothesis(score, 0.2, *names)
        for score, *names in ((0.0,), (-600.0, "drag"), (-700.0, "friction"))
    ]
    before = Tried(host(), found, found[-1])
    tried = told.with_one(late, before)
    assert asked == [{"friction"}]
    effects = {item.effects: item.score for item in tried.found}
    assert effects == {(): -1.0, ("friction",): -800.0, ("drag",): -610.0}
    assert tried.before is before
    told.with_one(late)  # nothing was found before it
    assert asked[-1] == set(forces)


@pytest.mark.parametrize(("left", "wanted"), [(0.005, 0), (0.3, 2)])
def test_beside_a_timing_the_host_without_it_is_tried_with_lags_alone(
    trial, monkeypatch, left, wanted
):
    asked = []

    def together(self, found, *_):
        asked.append(set(self.offer(found[-1])))
        return found

    monkeypatch.setattr(ForceSearch, "together", together)
    monkeypatch.setattr(try_hosts, "chosen", lambda found, *_: found[-1])
    monkeypatch.setattr(try_hosts, "charged", lambda item, *_: item.score)
    monkeypatch.setattr(try_hosts, "more_for_numbers", lambda *_: 0.0)

    def tried(score, numbers, before=None):
        own = hypothesis(score, left, "friction")
        own.state.free = [None] * numbers
        one = host()
        one.fitted = own
        return Tried(one, [own], own, before)

    first = tried(-500.0, 2)
    late = tried(-600.0, 3, first)
    forces = {"friction": [], "drive-lag": [], "drag": []}
    best = best_with_several(offering(trial, forces), [first, late], float("inf"))
    assert asked == [{"drive-lag"}, set(forces)][:wanted]
    assert best.best is late.best


def test_what_leaves_more_than_the_base_is_not_chosen_in_a_host(trial):
    """It may score less: one record that is nearly met counts much in a logarithm."""
    alone, worse, fair = (
        hypothesis(score, left, *names)
        for score, left, *names in (
            (0.0, 1.5),
            (-900.0, 1.2, "asymmetry"),
            (-600.0, 0.2, "gravity"),
        )
    )
    for item in (alone, worse, fair):
        item.state.gap = lambda square: 1.0
        item.state.share = lambda before, square, gap: 1.0
    for found, best in (([alone, worse, fair], fair), ([alone, worse], alone)):
        tried = trial.of(host(), found)
        assert tried.best is worse  # a further effect may take more
        assert trial.of_better(tried).best is best
    tried = Tried(host(), [alone, worse, fair], fair)
    assert trial.of_better(tried) is tried
