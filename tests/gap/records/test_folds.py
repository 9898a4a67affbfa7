"""Folds judge each sample once, and never by a fit that read it or its neighbours."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.gap.records.folds import make_folds
from tests.gap.made import record, sine


@given(st.lists(st.integers(100, 400), min_size=1, max_size=12))
def test_every_sample_judges_once_and_never_where_it_fits(lengths):
    records = [
        record(sine(1 + place, count=count), name=f"r{place}")
        for place, count in enumerate(lengths)
    ]
    folds = make_folds(records)
    assert 3 <= len(folds) <= 5
    for place, item in enumerate(records):
        judged = np.sum([fold.validation[place] for fold in folds], axis=0)
        assert np.array_equal(judged, np.ones(len(item)))
    for fold in folds:
        assert any(mask.any() for mask in fold.train)
        assert any(mask.any() for mask in fold.validation)
        for train, validation in zip(fold.train, fold.validation, strict=True):
            assert not np.any(train & validation)


@pytest.mark.parametrize("count", [3, 4, 5, 9, 11])
def test_three_records_or_more_are_held_out_whole(count):
    folds = make_folds([record(sine(1 + place)) for place in range(count)])
    for fold in folds:
        for train, validation in zip(fold.train, fold.validation, strict=True):
            assert train.all() != validation.all()
            assert train.any() != validation.any()


def test_neighbours_in_rate_are_held_out_in_different_folds():
    frequencies = [40, 1, 20, 5, 10, 80, 2]
    folds = make_folds([record(sine(each)) for each in frequencies])
    of = {
        each: next(k for k, fold in enumerate(folds) if fold.validation[place].all())
        for place, each in enumerate(frequencies)
    }
    ordered = sorted(frequencies)
    for slower, faster in pairwise(ordered):
        assert of[slower] != of[faster]


@pytest.mark.parametrize("count", [1, 2])
def test_blocks_keep_a_guard_gap(count):
    folds = make_folds([record(sine(3, count=1000))] * count)
    for fold in folds:
        for train, validation in zip(fold.train, fold.validation, strict=True):
            inside = np.flatnonzero(validation)
            assert np.array_equal(inside, np.arange(inside[0], inside[-1] + 1))
            gap = np.abs(np.flatnonzero(train)[:, None] - inside[[0, -1]]).min()
            assert gap > 0.1 * len(inside)


def test_blocks_are_whole_periods_where_there_are_as_many():
    folds = make_folds([record(sine(10, count=950), period_samples=100)])
    for fold in folds:
        assert np.flatnonzero(fold.validation[0])[0] % 100 == 0


@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize("lead", [300, 500])
def test_blocks_divide_what_is_scored(count, lead):
    folds = make_folds([record(sine(3, count=1000), lead=lead)] * count)
    assert len(folds) == 4
    for fold in folds:
        for train, validation in zip(fold.train, fold.validation, strict=True):
            assert validation.sum() == (1000 - lead) / 4
            assert train.any()


def test_a_block_in_which_nothing_was_measured_is_no_fold():
    interpolated = np.zeros(1000, dtype=bool)
    interpolated[240:510] = True
    folds = make_folds([record(sine(3, count=1000), interpolated=interpolated)])
    assert len(folds) == 3
    assert all(fold.validation[0].any() for fold in folds)


def test_blocks_may_be_asked_for_however_many_records():
    records = [record(sine(1 + place)) for place in range(6)]
    assert all(
        mask.any() and not mask.all()
        for fold in make_folds(records, whole=False)
        for mask in (*fold.train, *fold.validation)
    )
