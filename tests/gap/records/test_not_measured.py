"""ViewSamples that were interpolated carry no weight in the gap's scores."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.gap.holdout.shrink import shrink
from hystbench.gap.locate.samples import ViewSamples
from hystbench.gap.records.black_box import BlackBox
from hystbench.gap.records.evidence import load_evidence
from hystbench.gap.records.floor import Floor
from hystbench.gap.records.folds import make_folds
from hystbench.gap.records.nuisance import left_over, left_rms, path_and_mains
from hystbench.gap.records.scored_samples import Compared, ScoredSamples
from hystbench.model import load_model
from tests.gap.closing import close_gap
from tests.gap.made import record, sine
from tests.gap.searched import among
from tests.gap.tiny import LAG_S, write_tiny

LOST = [0, 1, 700, 701, 702, 1500]
GARBAGE = 1e6


def pair(n=4):
    """The same records twice; the outputs that were not measured differ wildly."""
    lost = np.zeros(2000, dtype=bool)
    lost[LOST] = True
    clean = []
    for k in range(n):
        u = sine(3 + 4 * k) + 0.2 * sine(31)
        noise = np.random.default_rng(k).normal(0, 0.02, len(u))
        y = 5 * u + 0.5 * u**3 + noise
        clean.append(replace(record(u, y, name=f"r{k}"), interpolated=lost))
    return clean, [replace(item, y=np.where(lost, GARBAGE, item.y)) for item in clean]


@pytest.fixture(scope="module")
def both():
    return pair()


def base(records):
    return [5 * item.u for item in records]


def test_none_of_them_is_scored_in_the_fit(both):
    clean, _ = both
    sample = ScoredSamples.of(clean)
    for positions in sample.positions:
        assert not set(LOST) & set(positions.tolist())
        assert (np.diff(positions) > 0).all()
    assert [len(p) for p in ScoredSamples.of(clean, 10**6).positions] == [2000 - 6] * 4


def test_a_whole_record_is_sampled_as_before():
    whole = record(sine(3))
    masked = replace(whole, interpolated=np.zeros(2000, dtype=bool))
    (a,), (b,) = (ScoredSamples.of([item]).positions for item in (whole, masked))
    np.testing.assert_array_equal(a, b)


@pytest.mark.parametrize("nuisance", [None, path_and_mains(1, [50.0])])
def test_hold_out_numbers_do_not_see_them(both, nuisance):
    _, spoilt = both
    shown = []
    for records in both:
        before = base(records)
        after = [y + 0.5 * item.u**3 for y, item in zip(before, records, strict=True)]
        found, rows, _ = shrink(
            records, before, after, Floor(0.02, "declared"), nuisance
        )
        steps = [left_rms(records, x, nuisance) for x in (before, after)]
        shown.append((found, rows, steps))
    assert shown[0] == shown[1]
    assert left_over(spoilt[0], base(spoilt)[0], nuisance)[1].sum() < 2000


@pytest.mark.parametrize("count", [2, 4])
def test_they_neither_fit_nor_judge_on_folds(both, count):
    clean, _ = both
    for fold in make_folds(clean[:count]):
        for masks in (fold.train, fold.validation):
            assert not any(mask[LOST].any() for mask in masks)


def test_the_yardstick_does_not_see_them(both):
    boxes = [
        BlackBox.fit(
            [Compared(*x) for x in zip(records, base(records), strict=True)],
            make_folds(records, whole=False),
            0.02,
        )
        for records in both
    ]
    np.testing.assert_array_equal(boxes[0].weights, boxes[1].weights)
    assert boxes[0].explained_on_folds == boxes[1].explained_on_folds


def test_views_of_samples_do_not_see_them(both):
    seen = []
    for records in both:
        items = tuple(Compared(*x) for x in zip(records, base(records), strict=True))
        view = ViewSamples(items, Floor(0.02, "declared"), 1)
        assert len(view.residual) == len(view.time) == len(view.input) == 4 * 1994
        assert view.kept.slices[-1].stop == 4 * 1994
        seen.append(view.residual)
    np.testing.assert_array_equal(*seen)


@pytest.mark.usefixtures("unrendered")
def test_a_gap_is_found_beside_records_with_holes(tmp_path):
    """Every view and stage takes records of which different samples are missing."""
    data, base = write_tiny(tmp_path)
    about = (data / "dataset.yaml").read_text()
    for name, lost in (("fast", range(400, 460)), ("unseen", [900, 901])):
        rows = (data / f"{name}.csv").read_text().splitlines()
        for k in lost:
            rows[k] = rows[k].rpartition(",")[0] + ","
        (data / f"{name}.csv").write_text("\n".join(rows) + "\n")
        about = about.replace(
            f"file: {name}.csv,", f"file: {name}.csv, missing: interpolate,"
        )
    (data / "dataset.yaml").write_text(about)
    # An effect of each place, and what the lag may be taken for.
    likely = among(
        *("drive-lag", "sensor-lag", "input-delay", "eddy-diffusion", "hysteresis"),
        *("asymmetry", "creep", "drift", "mains-pickup", "calibration-error"),
    )
    found = close_gap(
        load_evidence(data), load_model(base), tmp_path / "out", vocabulary=likely
    )
    (effect,) = found.outcome.content["effects"]
    assert effect["name"] == "drive-lag"
    number = effect["parameters"]["time_constant_s"]
    assert number["value"] == pytest.approx(LAG_S, rel=0.02)
