"""What is looked at on few samples, and what of it on all records."""

from types import SimpleNamespace

import numpy as np
import pytest

from hystbench.gap.effects.effect import Declined
from hystbench.gap.fitting.tried import LEAST, MORE, Seen, first_periods, on_all_records
from hystbench.gap.fitting.variant_search import Trial
from tests.gap.made import record

NOW = 100.0


def looked_at(effect, gain, score, begun=False, freedom=0.0):
    """A variant that gains so much at a glance, and scores so much on all records."""
    grids = {"x": np.arange(3.0)}
    variant = SimpleNamespace(effect=effect, grids=grids, begun=begun, freedom=freedom)

    def at(point):
        if score is None:
            raise Declined("refused")
        return Trial(one, {"x": point[0]}, score)

    one = SimpleNamespace(variant=variant, at=at)
    return Seen(one, ((1.0,),), gain)


def gains_of(looks, least):
    found, refused = on_all_records(looks, NOW, least)
    return [NOW - trial.score for trial in found], refused


def test_what_gains_too_little_at_a_glance_stays_as_it_was_seen():
    """Too little beside the best of all, wherever that stands."""
    looks = [looked_at("a", 5.0, 90.0), looked_at("b", 60.0, 20.0)]
    assert gains_of(looks, lambda most: most / 2)[0] == [5.0, 80.0]
    enough = 40.0 / MORE
    looks = [looked_at("a", enough, 90.0), looked_at("b", 60.0, 20.0)]
    assert gains_of(looks, lambda most: most / 2)[0] == [10.0, 80.0]


def test_a_charge_for_numbers_is_paid_once():
    """Four times as much as at a glance are gained beside what its numbers cost."""
    looks = [looked_at("a", -10.0, 60.0, freedom=10.0), looked_at("b", 60.0, 20.0)]
    assert gains_of(looks, lambda most: most / 2)[0] == [40.0, 80.0]


def test_what_needs_a_whole_fit_is_always_looked_at():
    looks = [looked_at("a", 5.0, 90.0, begun=True), looked_at("b", 60.0, 20.0)]
    assert gains_of(looks, lambda most: most / 2)[0] == [10.0, 80.0]


def test_an_effect_is_refused_if_all_its_variants_are():
    looks = [looked_at("a", 9.0, None), looked_at("b", 8.0, None)]
    looks.append(looked_at("b", 7.0, 95.0))
    assert gains_of(looks, lambda most: 0.0) == ([5.0], {"a": "refused"})


@pytest.mark.parametrize(
    ("period", "count", "kept"),
    [(100, 10, 2), (100, 2, None), (10, 100, 15), (None, 10, None), (101, 10, None)],
)
def test_the_first_of_whole_periods_stand_for_all(period, count, kept):
    """Two at least, and as many as hold enough scored samples; else all of it."""
    samples = 10 * count if period == 10 else 100 * count
    u = np.sin(np.arange(samples))
    one = record(u, u, period_samples=period)
    found = first_periods(one, scored=len(one))
    if kept is None:
        assert found is one
    else:
        assert len(found) == kept * period
        assert len(found) >= LEAST
        assert found.repeats
        np.testing.assert_array_equal(found.u, one.u[: len(found)])
