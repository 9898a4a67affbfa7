"""Long records of a slow input with fewer samples."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.gap.records.coarser import ENOUGH, coarser, left_out, sparing
from hystbench.record import Channel, Record


def record(highest, n=4 * ENOUGH, period=None):
    """A multisine up to a frequency, in shares of the sampling rate."""
    cycles = np.arange(1, int(highest * n) + 1)
    if period is not None:
        cycles = cycles[cycles % (n // period) == 0]
    phases = np.pi * cycles * (cycles + 1) / len(cycles)
    angles = 2 * np.pi * np.outer(np.arange(n), cycles) / n
    u = np.cos(angles + phases).sum(axis=1)
    y = np.sin(angles + phases).sum(axis=1)
    made = Channel("u", "A"), Channel("y", "um")
    return Record("r", 1e-3, u, y, *made, "measured", period_samples=period)


@pytest.mark.parametrize(("highest", "factor"), [(0.02, 4), (0.1, 2), (0.2, 1)])
def test_the_input_says_how_many_samples_can_be_spared(highest, factor):
    one = record(highest)
    assert sparing([one], "band-limited") == factor
    (kept,) = coarser((one,), "band-limited")
    assert len(kept) == len(one) // factor
    assert kept.dt == pytest.approx(factor * one.dt)
    np.testing.assert_array_equal(kept.u, one.u[::factor])
    np.testing.assert_array_equal(kept.y, one.y[::factor])


@pytest.mark.parametrize("hold", ["zero-order", "linear"])
def test_no_sample_of_a_staircase_or_of_straight_lines_can_be_spared(hold):
    one = record(0.02)
    assert coarser((one,), hold)[0] is one


def test_a_short_record_is_left_as_it_is():
    one = record(0.02, n=ENOUGH)
    assert coarser((one,), "band-limited")[0] is one


def test_of_whole_periods_the_last_ones_are_kept():
    one = record(0.02, n=8 * ENOUGH, period=4 * ENOUGH)
    (kept,) = coarser((one,), "band-limited")
    assert kept.period_samples == len(kept) == ENOUGH
    np.testing.assert_array_equal(kept.u, one.u[4 * ENOUGH :: 4])


def test_a_period_stays_whole():
    # Neither every second nor every third sample of 6005 makes a whole period.
    one = record(0.02, n=2 * 6005, period=6005)
    (kept,) = coarser((one,), "band-limited")
    assert kept.period_samples == len(kept) == 6005


def test_no_period_is_left_out_beside_a_record_that_does_not_repeat():
    """On that one a model could not begin as if its periods had come before."""
    repeats = record(0.02, n=8 * ENOUGH, period=4 * ENOUGH)
    others = (repeats, record(0.02, n=8 * ENOUGH))
    kept = coarser(others, "band-limited")
    assert [len(item) * item.dt for item in kept] == pytest.approx(
        [len(item) * item.dt for item in others]
    )
    assert not left_out(kept, others)
    assert left_out(coarser(others[:1], "band-limited"), others[:1])


def test_samples_that_were_not_measured_are_not_the_ones_that_stay():
    one = record(0.02)
    lost = np.zeros(len(one), dtype=bool)
    lost[::4] = True
    (kept,) = coarser((replace(one, interpolated=lost),), "band-limited")
    assert kept.counted.sum() >= ENOUGH
