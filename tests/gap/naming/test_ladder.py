"""The ladder of the gap: the base, the base re-tuned, then effect by effect."""

from itertools import pairwise

import pytest

from hystbench.gap.fitting.state import Added, Free
from hystbench.gap.holdout.scored import score_hold_out
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.naming.ladder import BASE, RETUNED, contributions, rungs
from hystbench.gap.naming.rounds import Round
from hystbench.model import Model
from tests.gap.made import CURRENT, DISPLACEMENT
from tests.gap.searched import search
from tests.gap.small import block, measured, state_of


def with_names(*names, free=()):
    """A state with added effects of these names."""
    added = tuple(Added(name, "drive", "", (), {}, 1.0) for name in names)
    return state_of((block("gain", value=2.0),), added=added, free=free)


def named(final, *befores):
    one = [Round(state, 0.0, (), True) for state in befores]
    return Named(final, tuple(one))


def test_each_effect_is_a_rung_of_the_model_that_was_fitted_with_it():
    start, one, final = with_names(), with_names("lag"), with_names("lag", "drift")
    found = rungs(start, named(final, start, one))
    assert [item.name for item in found] == [BASE, "lag", "drift"]
    assert [item.state for item in found] == [start, one, final]


def test_a_base_that_is_free_has_a_rung_of_its_own():
    free = (Free(0, "value"),)
    start, again, final = (with_names(free=free) for _ in range(3))
    found = rungs(start, named(final, again))
    assert [item.name for item in found] == [BASE, RETUNED]
    assert found[0].state is start
    assert found[1].state is final


@pytest.mark.parametrize(
    ("free", "told"),
    [
        ((), "what drive-lag adds"),
        ((Free(0, "value"),), "what drive-lag adds to the re-tuned base"),
    ],
)
def test_what_an_effect_adds_is_told_with_the_base_that_it_is_added_to(free, told):
    """A base whose numbers were fitted without it may have taken its part."""
    start, again = (with_names(free=free) for _ in range(2))
    final = with_names("drive-lag", free=free)
    (found,) = contributions(rungs(start, named(final, again)))
    assert found.words == told


def test_a_last_round_that_adds_nothing_is_no_rung():
    start, one, final = with_names(), with_names("lag"), with_names("lag")
    found = rungs(start, named(final, start, one))
    assert [item.name for item in found] == [BASE, "lag"]
    assert found[-1].state is final


def test_an_effect_that_takes_the_place_of_another_is_named_with_what_was_added():
    start, one = with_names(), with_names("lag")
    final = with_names("delay", "drift")
    found = rungs(start, named(final, start, one))
    assert [item.name for item in found] == [BASE, "delay + drift"]


def test_an_effect_that_went_out_again_lends_its_name_to_no_other_model():
    start, one, two = (with_names(*names) for names in ((), ("lag",), ("lag", "creep")))
    final = with_names("lag")
    found = rungs(start, named(final, start, one, two))
    assert [item.name for item in found] == [BASE, "lag"]
    assert found[-1].state is final


def test_an_effect_that_went_and_came_again_has_one_rung():
    """Between them stood another in its place, and one that is gone at the end."""
    steps = [(), ("gain",), ("bend", "creep"), ("drift", "creep"), ("drift",)]
    befores = [with_names(*names) for names in steps]
    final = with_names("drift", "gain")
    found = rungs(befores[0], named(final, *befores))
    assert [item.name for item in found] == [BASE, "gain", "drift"]
    assert found[1].state is befores[1]
    # Each rung has all of the one before, and is called by what it has more.
    for one, other in pairwise(found):
        had, has = ({x.effect for x in each.state.added} for each in (one, other))
        assert has - had == set(other.name.split(" + "))
        assert had < has


def test_effects_that_all_went_out_again_have_no_rung():
    start, one = with_names(), with_names("lag")
    none_named = named(one, start).with_none_named()
    (base,) = rungs(start, none_named)
    assert (base.name, base.state) == (BASE, start)


@pytest.fixture(scope="module")
def retuned():
    """A gain that is wrong by a tenth, in a base that may change it; nothing else."""
    records = measured((block("gain", value=11.0),), noise=0.05)
    chain = (block("gain", value=10.0),)
    base = Model("base", CURRENT, DISPLACEMENT, chain, free=("gain.value",))
    return base, search("made", records, base), records


def test_the_ladder_of_a_re_tuned_base_on_records_it_has_not_seen(retuned):
    _, found, _ = retuned
    held = measured((block("gain", value=11.0),), noise=0.05, seed=9)
    shown = score_hold_out(found, held)
    ladder = shown.content["ladder"]
    assert [item["name"] for item in ladder] == [BASE, RETUNED]
    assert ladder[0]["rms"] == pytest.approx(shown.content["gap"]["before"])
    assert ladder[1]["rms"] == pytest.approx(shown.content["gap"]["after"])
    # What is left is the noise that was put in.
    assert ladder[1]["rms"] == pytest.approx(0.05, rel=0.05)
    assert ladder[0]["rms"] > 2 * ladder[1]["rms"]


def test_what_the_base_leaves_free_stays_free(retuned):
    _, found, _ = retuned
    assert found.model.free == ("gain.value",)
