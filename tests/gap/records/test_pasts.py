"""The period before a record that begins in a steady motion."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.gap.records.folds import make_folds
from hystbench.gap.records.nuisance import left_over
from hystbench.gap.records.pasts import is_steady, with_pasts
from tests.gap.made import play_sum, record, sine

PERIOD, PERIODS = 200, 5
LOOP = [0.2, 0.5], [1.0, 0.5]


def loop(periods, noise=0.01):
    """A loop of play operators from rest, over so many periods; noise of its own."""
    u = sine(5.0, count=periods * PERIOD) + 0.3 * sine(15.0, count=periods * PERIOD)
    return u, play_sum(u, *LOOP) + noise * np.random.default_rng(4).standard_normal(
        len(u)
    )


def steady(periods=4, noise=0.01):
    """The record without its first period."""
    u, y = (x[PERIOD:] for x in loop(periods + 1, noise))
    return record(u, y, period_samples=PERIOD)


@pytest.mark.parametrize("periods", [2, 3, 4])
@pytest.mark.parametrize("noise", [0.0, 0.01])
def test_the_period_that_came_before_is_put_back(periods, noise):
    cut = steady(periods, noise)
    (found,) = with_pasts([cut])
    assert (found.lead, found.past) == (PERIOD, PERIOD)
    assert len(found) == len(cut) + PERIOD
    whole = play_sum(found.u, *LOOP)  # from rest, as a model runs
    missed = found.y - whole
    assert np.std(missed[found.counted]) < 1.1 * noise + 1e-12
    assert found.time[PERIOD] == 0.0
    early = np.std(cut.y - play_sum(cut.u, *LOOP))
    assert early > 2 * np.std(missed[found.counted])


def test_a_record_from_rest_stays_as_it_is():
    for periods in (2, 3, 5):
        u, y = loop(periods)
        rests = record(u, y, period_samples=PERIOD)
        assert not is_steady(rests)
        assert with_pasts([rests]) == (rests,)


def test_a_tone_that_the_input_does_not_explain_hides_no_steady_motion():
    cut = steady(4)
    hum = 0.2 * sine(52.3, count=len(cut))
    assert is_steady(replace(cut, y=cut.y + hum))


def test_an_input_that_fades_in_was_not_there_before():
    cut = steady(4, noise=0.1)
    u = cut.u * np.minimum(np.arange(len(cut)) / PERIOD, 1.0)
    assert not is_steady(replace(cut, u=u))


def test_without_a_period_or_with_one_alone_nothing_is_known_of_before():
    cut = steady(1)
    assert not is_steady(cut)
    assert not is_steady(replace(steady(4), period_samples=None))


def test_what_was_not_measured_tells_nothing():
    cut = steady(3)
    y, lost = cut.y.copy(), np.zeros(len(cut), dtype=bool)
    y[20:40], lost[20:40] = 9.0, True
    (found,) = with_pasts([replace(cut, y=y, interpolated=lost)])
    assert found.past == PERIOD
    assert found.interpolated.sum() == 2 * lost.sum()


@pytest.mark.parametrize("periods", [2, 3, 4])
def test_what_goes_on_from_period_to_period_may_have_begun_here(periods):
    """Creep from rest, and a drift that hides the first branch of a loop."""
    u, y = loop(periods, noise=0.001)
    times = np.arange(len(u)) / PERIOD
    creep = record(u, u - 0.5 * np.expm1(-times / 10), period_samples=PERIOD)
    drift = record(u, y + 0.3 * times, period_samples=PERIOD)
    assert not is_steady(creep)
    assert not is_steady(drift)


def test_an_oscillation_that_dies_out_is_no_steady_motion():
    """Four samples a cycle: from one to the next it differs as noise does."""
    cut = steady(2)
    rings = np.exp(-np.arange(len(cut)) / 60) * np.cos(np.arange(len(cut)) * np.pi / 2)
    assert not is_steady(replace(cut, y=cut.y + 0.5 * rings))


def test_blocks_of_folds_lie_behind_the_past():
    (found,) = with_pasts([steady(2)])
    folds = make_folds([found], whole=False)
    judged = [int(fold.validation[0].sum()) for fold in folds]
    assert sum(judged) == 2 * PERIOD
    assert min(judged) > 0


def test_the_record_is_given_back_without_its_past():
    cut = steady(3)
    (found,) = with_pasts([cut])
    alone = found.as_measured
    assert alone.digest == cut.digest
    assert cut.as_measured is cut


def test_the_first_part_of_a_hold_out_record_lies_behind_the_past():
    """An offset that is new in it is told from its first 30 %."""
    (found,) = with_pasts([steady(2, noise=0.0)])
    simulated = play_sum(found.u, *LOOP) - 5.0
    left, scored = left_over(found, simulated, lambda item: np.ones((len(item), 1)))
    assert np.flatnonzero(scored)[0] == PERIOD + round(0.3 * 2 * PERIOD)
    assert left[scored] == pytest.approx(0.0, abs=1e-9)
