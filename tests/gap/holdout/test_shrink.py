"""Intervals on hold-out records hold the truth as often as they say."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.gap.holdout.shrink import (
    resampled_rms,
    rms_interval,
    share_explained,
    share_interval,
    shrink,
)
from hystbench.gap.records.floor import Floor
from hystbench.gap.records.nuisance import (
    degree_that_carries_on,
    left_over,
    left_rms,
    path_and_mains,
    without_nuisance,
)
from tests.gap.made import record, sine

LEVELS = st.floats(0.01, 10)


def bootstrap_interval(pairs, floor):
    return share_interval(*resampled_rms(pairs), floor)


def noise(seed, count=4000, size=1.0):
    return size * np.random.default_rng(seed).standard_normal(count)


@given(LEVELS, LEVELS, LEVELS)
def test_share_of_independent_parts(gap, rest, floor):
    # powers of independent parts add: gap + noise before, rest + noise after
    before, after = np.hypot(gap, floor), np.hypot(rest, floor)
    expected = 1 - rest**2 / gap**2
    share = share_explained(before, after, floor)
    assert share == pytest.approx(expected, rel=1e-6, abs=1e-6 * (floor / gap) ** 2)


@given(LEVELS, st.floats(0, 1), st.floats(0, 1), st.floats(0, 2))
def test_a_range_holds_the_share_of_every_floor_below_the_bound(
    before, left, part, bound
):
    after = left * before
    floor = part * min(bound, after)
    share = share_explained(before, after, floor)
    low, high = share_explained(before, after, bound, upper_bound=True)
    if share is not None:
        assert low - 1e-9 <= share <= high * (1 + 1e-9) + 1e-9


def test_nothing_above_the_floor_has_no_share():
    assert share_explained(1.0, 0.5, 1.0) is None
    assert share_explained(0.0, 0.0, 1.0, upper_bound=True) is None


def test_no_spectrum_is_computed_before_one_is_drawn(monkeypatch):
    def welch(*given, **more):
        pytest.fail("a spectrum that nobody reads")

    monkeypatch.setattr("scipy.signal.welch", welch)
    made = record(sine(2), noise(1, 2000))
    shrink([made], [np.zeros(2000)], [0.5 * made.y], Floor(0.1, "declared"))


def test_before_and_after_over_records_of_other_lengths():
    records = [record(sine(2, count=n), noise(n, n), name=f"{n}") for n in (500, 1500)]
    simulated = [0.25 * item.y for item in records]
    zeros, floor = [np.zeros(500), np.zeros(1500)], Floor(0.0, "declared")
    whole, rows, _ = shrink(records, zeros, simulated, floor)
    joined = np.concatenate([item.y for item in records])
    assert whole["before"] == pytest.approx(np.sqrt(np.mean(joined**2)))
    assert whole["after"] == pytest.approx(0.75 * whole["before"])
    assert whole["explained"] == pytest.approx(1 - 0.75**2)
    assert [row["explained"] for row in rows] == pytest.approx([1 - 0.75**2] * 2)
    # the same share in every block: an interval without width
    assert whole["interval"] == pytest.approx((1 - 0.75**2, 1 - 0.75**2))


def test_interval_covers_the_truth_as_often_as_it_says():
    # A residual of known variances: the share is 1 - 0.5^2 whatever the draw.
    covered = 0
    for seed in range(100):
        pairs = []
        for place in range(4):
            parts = noise((seed, place, 0)), noise((seed, place, 1))
            pairs.append((parts[0], 0.5 * parts[1]))
        low, high = bootstrap_interval(pairs, 0.0)
        covered += low <= 0.75 <= high
    assert covered >= 88


def test_the_interval_holds_the_share_where_all_is_left_at_an_end():
    """The start of a record is drawn as often as the rest."""
    before = noise(1)
    after = 0.01 * noise(2)
    after[: len(after) // 100] = before[: len(after) // 100]
    share = 1 - float(after @ after) / float(before @ before)
    low, high = bootstrap_interval([(before, after)], 0.0)
    assert low <= share <= high


def test_intervals_of_rms_cover_the_truth_as_often_as_they_say():
    """Of noise of known levels, for three models drawn together."""
    levels = (1.0, 0.5, 2.0)
    covered = np.zeros(3)
    for seed in range(100):
        residuals = [
            tuple(noise((seed, place, k), size=s) for k, s in enumerate(levels))
            for place in range(4)
        ]
        for k, drawn in enumerate(resampled_rms(residuals)):
            low, high = rms_interval(drawn)
            covered[k] += low <= levels[k] <= high
    assert (covered >= 88).all()


def test_one_drawing_serves_all_models():
    """What is half of another is half of it in every draw, alone or together."""
    before, other = noise(1), noise(2)
    drawn = resampled_rms([(before, other, 0.5 * before)])
    assert drawn[2] == pytest.approx(0.5 * drawn[0])
    assert resampled_rms([(other,)])[0] == pytest.approx(drawn[1], rel=1e-12)


def test_rms_and_share_come_with_the_intervals_of_one_drawing():
    records = [
        record(sine(2, count=n), noise(n, n), name=f"{n}") for n in (500, 1500, 900)
    ]
    zeros = [np.zeros(len(item)) for item in records]
    after = [0.75 * item.y for item in records]
    found = shrink(records, zeros, after, Floor(0.0, "declared")).gap
    assert found["before_interval"][0] < found["before"] < found["before_interval"][1]
    quarter = [0.25 * end for end in found["before_interval"]]
    assert found["after_interval"] == pytest.approx(quarter)
    assert found["interval"] == pytest.approx((1 - 0.25**2, 1 - 0.25**2))


def test_interval_is_wider_where_neighbours_go_together():
    white = noise(1), 0.5 * noise(2)
    kernel = np.ones(100) / 10
    slow = tuple(np.convolve(each, kernel, "same") for each in white)
    widths = [np.ptp(bootstrap_interval([pair], 0.0)) for pair in (white, slow)]
    assert widths[1] > 2 * widths[0]


def test_a_path_is_carried_on_as_far_as_the_fit_records_bear_it_out():
    """A steady drift along its slope, a bent one along its bend, a wandering not."""
    time = np.arange(3000) * 1e-3
    rng = np.random.default_rng(4)
    walks = [np.cumsum(rng.standard_normal(3000)) / 50 for _ in range(6)]
    slopes = [a * time for a in rng.uniform(-2, 2, 6)]
    bends = [a * time**2 for a in rng.uniform(-2, 2, 6)]
    for paths, expected in ((walks, 0), (slopes, 1), (bends, 2)):
        made = [
            record(sine(2, count=3000), path + noise(k, 3000, 0.02), name=f"r{k}")
            for k, path in enumerate(paths)
        ]
        nothing = [np.zeros(3000)] * 6
        assert degree_that_carries_on(made, nothing) == expected


def test_offset_and_mains_are_estimated_on_the_first_part_only():
    time = np.arange(4000) * 0.001
    new = 0.3 + 0.2 * np.sin(2 * np.pi * 50 * time + 1)
    rest = noise(3, size=0.01)
    item = record(sine(2, count=4000), new + rest)
    nuisance = path_and_mains(0, [50.0])
    _, scored = left_over(item, 0 * time, nuisance)
    assert np.array_equal(np.flatnonzero(~scored), np.arange(1200))
    left = without_nuisance(item.y, nuisance(item), ~scored)
    assert np.std(left[scored]) < 0.02
    # what comes later in the record changes nothing that is taken off
    later = np.where(scored, 9 * item.y, item.y)
    taken = item.y - left
    assert later - without_nuisance(later, nuisance(item), ~scored) == pytest.approx(
        taken, abs=1e-9
    )


def test_nuisance_treats_base_and_augmented_alike():
    time = np.arange(4000) * 0.001
    item = record(sine(2, count=4000), 5 + 0 * time + sine(7, count=4000))
    zero = np.zeros(4000)
    floor = Floor(0.1, "repeats")
    same = shrink([item], [zero], [zero], floor, path_and_mains(0)).gap
    assert same["explained"] == 0
    assert same["before"] == same["after"] < 1
    assert same["interval"] == [0, 0]


def test_rms_goes_down_with_what_is_added():
    first, second = sine(3, amplitude=2, count=1000), sine(11, count=1000)
    item = record(sine(1, count=1000), first + second)
    outputs = (np.zeros(1000), first, first + second, None)
    *sizes, away = (left_rms([item], [output]) for output in outputs)
    # whole periods of sines: amplitude over root two, orthogonal
    assert sizes == pytest.approx([np.sqrt((4 + 1) / 2), np.sqrt(1 / 2), 0])
    assert away is None
