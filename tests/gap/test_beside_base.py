"""When a re-tuned base takes the place of one that was given."""

from types import SimpleNamespace

import pytest

from hystbench.gap.beside_base import BesideBase, stays
from hystbench.gap.fitting.own_values import NONE
from hystbench.gap.fitting.state import Added
from hystbench.gap.records.floor import Floor
from tests.gap.small import block, measured, state_of

NOISE = 0.01
GAIN = block("gain", value=12.0)
PLAY = block("backlash", half_width=0.8)


def model(records, *added, charge=1.0):
    """A gain with what is added, as a law of so many numbers."""
    effect = Added("backlash", "mechanics", "", (1,), {}, charge)
    return state_of((GAIN, *added), records, added=(effect,) if added else ())


def beside(records, *added, charge=1.0, rivals=()):
    """What stands beside a gain, with the laws that stood beside it in its round."""
    start, state = model(records), model(records, *added, charge=charge)
    ranking = [SimpleNamespace(state=each) for each in (state, None, *rivals)]
    named = SimpleNamespace(state=state, rounds=(SimpleNamespace(ranking=ranking),))
    return BesideBase(None, start, Floor(NOISE, "stated"), named, None, NONE)


@pytest.fixture
def records():
    return measured((GAIN, PLAY), NOISE)


def test_a_law_of_many_numbers_is_no_rival_of_one_of_few_that_leaves_as_little(records):
    few, many = beside(records, PLAY), beside(records, PLAY, charge=17.0)
    # Both leave the same; a re-tuned base has to pay as an effect does.
    assert stays(few, few, re_tuned=True)
    assert not stays(many, few, re_tuned=True)
    assert stays(few, many, re_tuned=True)


def test_it_stays_where_a_law_of_few_leaves_more(records):
    wider = block("backlash", half_width=0.9)
    assert stays(beside(records, PLAY, charge=17.0), beside(records, wider), True)


@pytest.mark.parametrize(
    ("half_width", "charge", "repeated"),
    [(0.8, 17.0, True), (0.3, 17.0, False), (0.8, 1.0, False)],
)
def test_naming_is_repeated_for_a_law_of_many_where_one_of_few_comes_near(
    records, half_width, charge, repeated
):
    """Beside a re-tuned base that one may do as well."""
    few = model(records, block("backlash", half_width=half_width))
    found = beside(records, PLAY, charge=charge, rivals=(few,))
    assert found.may_be_simpler() == repeated


def test_naming_is_repeated_for_a_law_of_many_where_the_base_alone_comes_near():
    """A gain that is off: nothing is needed beside another one."""
    given = measured((block("gain", value=12.6),), NOISE)
    found = beside(given, block("backlash", half_width=1e-3), charge=17.0)
    assert found.may_be_simpler()


def test_a_base_stays_where_the_other_was_scored_on_fewer_samples(records):
    shorter = [record.cut(slice(1000, None)) for record in records]
    for re_tuned in (False, True):
        assert stays(beside(records, PLAY), beside(shorter, PLAY), re_tuned)
