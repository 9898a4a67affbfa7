"""The beginnings of records: long enough to tell likely laws from unlikely ones."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.blocks.gain import Gain
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.beginnings import Beginnings
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.record import Channel, Record

COUNT = 4000
TIME = np.arange(COUNT) * 1e-3


def state(*gaps):
    """Records of a gain of one, each with a gap of its own beside it."""
    u = np.sin(2 * np.pi * 3 * TIME)
    channels = Channel("force", "N"), Channel("position", "mm")
    records = tuple(
        Record(f"run-{k}", 1e-3, u, u + gap, *channels, "measured", "fit")
        for k, gap in enumerate(gaps)
    )
    return ModelState(
        (Gain(value=1.0, offset=0.0),), records, ScoredSamples.of(records)
    )


def beginnings(model):
    score = Score.plain(model.sample, 1e-6)
    return Beginnings.of(model, score)


def shares(model):
    """Which share of each record is left."""
    return [len(record) / COUNT for record in beginnings(model).records]


def test_a_gap_at_the_very_start_leaves_a_quarter_of_the_record():
    """All of its power has passed in a hundredth: far too little to fit a law to."""
    (share,) = shares(state(np.exp(-TIME / 0.01)))
    assert 0.25 <= share < 0.26


def test_a_gap_that_goes_on_alike_leaves_a_quarter_of_the_record():
    (share,) = shares(state(0.1 * np.sin(2 * np.pi * 50 * TIME)))
    assert 0.25 <= share < 0.26


def test_a_gap_that_grows_leaves_what_holds_a_quarter_of_its_power():
    # The power of t passes as t^3: a quarter of it at 0.25^(1/3) of the record.
    (share,) = shares(state(TIME))
    assert share == pytest.approx(0.25 ** (1 / 3), abs=0.01)


def test_a_gap_at_the_very_end_leaves_the_whole_record():
    (share,) = shares(state(np.where(np.arange(COUNT) < 0.99 * COUNT, 0.0, 1.0)))
    assert share > 0.99


def test_without_a_gap_a_quarter_of_the_record_is_left():
    (share,) = shares(state(np.zeros(COUNT)))
    assert 0.25 <= share < 0.26


def test_every_record_is_cut_by_itself():
    early, late = shares(state(np.exp(-TIME / 0.01), TIME))
    assert early < 0.26
    assert late > 0.6


def test_of_records_that_repeat_the_two_ends_are_left_whole():
    sine = np.sin(2 * np.pi * 50 * TIME)
    whole = state(0.3 * sine, 0.1 * sine, 0.9 * sine, 0.2 * sine)
    lag = TransferFunction(
        numerator=(1.0,), denominator=(1e-9, 1.0), start="repeating", hold="linear"
    )
    whole = replace(whole, chain=(lag,))
    found = beginnings(whole)
    assert [record.name for record in found.records] == ["run-1", "run-2"]
    assert all(len(record) == COUNT for record in found.records)
    cut = found.cut(whole)
    np.testing.assert_allclose(cut.residual, whole.residual[found.kept], atol=1e-12)


def test_what_is_scored_of_a_beginning_is_that_of_the_whole_record():
    whole = state(TIME, np.exp(-TIME / 0.01))
    whole = replace(whole, correction=np.linspace(0, 1, len(whole.sample)))
    found = beginnings(whole)
    assert found.kept.sum() == len(found.sample) == len(found.score.directions)
    cut = found.cut(whole)
    np.testing.assert_array_equal(cut.residual, whole.residual[found.kept])
    for record, places in zip(found.records, found.sample.positions, strict=True):
        assert places[-1] < len(record)
