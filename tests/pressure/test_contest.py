"""The contest: grids, choices and ranks against plain counting."""

import math
from dataclasses import replace

import numpy as np
import pytest

from hystbench.adaptive import make_filter
from hystbench.errors import InputError
from hystbench.metrics import mean_square_error
from hystbench.pressure.contest import (
    Entry,
    Grid,
    geometric_mean,
    hold_contest,
    rank,
    run_grid,
)
from hystbench.pressure.runs import draw_signals, measure_twin
from hystbench.pressure.twins import read_twins

from .conftest import SIGNALS

CALIBRATED = ["sine-100hz", "sine-150hz"]


@pytest.fixture
def records(settings, twin_file):
    job = settings.contest_job
    signals = draw_signals(job["signals"], 0).values()
    return measure_twin(read_twins([twin_file])[0], signals, job["measure"], 0)


def grid(mse, signals=("a", "b", "c")):
    parts = [(0.1 * (n + 1),) for n in range(len(mse))]
    return Grid(parts, [{"mu": p[0]} for p in parts], list(signals), np.array(mse))


def test_the_step_is_chosen_by_geometric_mean_on_its_signals_alone():
    found = grid([[1.0, 8.0, 0.0], [2.0, 2.0, 9.0], [0.5, 9.0, 9.0]])
    # products over a and b: 8, 4, 4.5
    assert found.chosen(["a", "b"]) == 1
    assert found.chosen(["a"]) == 2
    assert found.chosen(["c"]) == 0


def test_a_step_that_diverges_is_never_chosen_where_another_does_not():
    found = grid([[math.inf, 1e-9, 1.0], [5.0, 5.0, 1.0], [math.inf] * 3])
    assert found.chosen(["a", "b"]) == 1
    assert grid([[math.inf] * 3] * 2).chosen(["a"]) == 0


def test_geometric_mean_with_zero_and_infinity():
    found = geometric_mean(np.array([[1.0, 100.0], [0.0, 4.0], [1.0, math.inf]]))
    np.testing.assert_allclose(found, [10.0, 0.0, math.inf])


def test_lms_grid_is_fractions_of_the_smallest_bound(settings, records):
    adaptive = make_filter(
        "delayed", settings.filter_job("delayed"), records[SIGNALS[0]]
    )
    found = run_grid(adaptive, "LMS", records, CALIBRATED, [0.5, 0.1], 0.01)
    bound = min(adaptive.bound(records[name].u).bound for name in CALIBRATED)
    assert found.fractions == [(0.1,), (0.5,)]
    np.testing.assert_allclose(
        [step["mu"] for step in found.steps], [0.1 * bound, 0.5 * bound]
    )
    # by hand: w += 2 mu e H
    record = records["sine-120hz"]
    w, line, squares = np.zeros(adaptive.taps), np.zeros(adaptive.taps), []
    for x, d in zip(record.u, record.y, strict=True):
        line = np.concatenate(([x], line[:-1]))
        e = d - w @ line
        w = w + 2 * 0.5 * bound * e * line
        squares.append(e**2)
    assert found.mse[1, list(records).index("sine-120hz")] == pytest.approx(
        np.mean(squares), rel=1e-9
    )


def test_nlms_grid_is_fractions_of_one(settings, records):
    job = settings.filter_job("delayed")
    adaptive = make_filter("delayed", job, records[SIGNALS[0]])
    found = run_grid(adaptive, "NLMS", records, CALIBRATED, [0.25], 0.01)
    assert found.steps == [{"mu": 0.25}]
    share = 0.01 / min(adaptive.bound(records[name].u).bound for name in CALIBRATED)
    record = records["sine-120hz"]
    w, line, squares = np.zeros(adaptive.taps), np.zeros(adaptive.taps), []
    for x, d in zip(record.u, record.y, strict=True):
        line = np.concatenate(([x], line[:-1]))
        e = d - w @ line
        w = w + 2 * 0.25 * e * line / (share + line @ line)
        squares.append(e**2)
    assert found.mse[0, list(records).index("sine-120hz")] == pytest.approx(
        np.mean(squares), rel=1e-9
    )


def test_each_step_size_of_volterra_has_the_whole_grid(settings, records):
    adaptive = make_filter(
        "volterra", settings.filter_job("volterra"), records[SIGNALS[0]]
    )
    one = {CALIBRATED[0]: records[CALIBRATED[0]]}
    found = run_grid(adaptive, "LMS", one, CALIBRATED[:1], [0.1, 0.2, 0.3], 0.01)
    assert len(set(found.fractions)) == 9
    assert found.mse.shape == (9, 1)


def test_step_sizes_of_a_record_are_one_call(settings, records, play_counts):
    job = settings.filter_job("backlash")
    adaptive = make_filter("backlash", job, records[SIGNALS[0]])
    fractions = [0.05 * number for number in range(1, 8)]
    found = run_grid(adaptive, "LMS", records, CALIBRATED, fractions, 0.01)
    assert play_counts == [len(fractions)] * len(records)
    for row, steps in enumerate(found.steps):
        alone = replace(adaptive, step_size=steps["mu"])
        for column, name in enumerate(found.signals):
            error = alone.run(records[name].u, records[name].y).error
            assert found.mse[row, column] == mean_square_error(error)


def test_held_out_signals_never_choose_their_own_step(settings, twin_file):
    job, twin = settings.contest_job, read_twins([twin_file])[0]
    entries = hold_contest(twin, job)
    held_out = [e for e in entries if e.protocol == "held-out"]
    best = {
        (e.algorithm, e.signal, e.model): e for e in entries if e.protocol == "best"
    }
    assert {e.signal for e in held_out} == set(SIGNALS) - set(CALIBRATED)
    assert {key[1] for key in best} == set(SIGNALS)
    for algorithm in ("LMS", "NLMS"):
        for model in job["filters"]:
            mine = [e for e in held_out if (e.algorithm, e.model) == (algorithm, model)]
            assert len({e.fractions for e in mine}) == 1
            for entry in mine:
                # its own best step can only be better
                assert best[algorithm, entry.signal, model].mse <= entry.mse
    for entry in held_out:
        rivals = [
            e.mse
            for e in held_out
            if (e.algorithm, e.signal) == (entry.algorithm, entry.signal)
        ]
        assert entry.rank == 1 + sum(mse < entry.mse for mse in rivals)
        assert entry.at_edge == bool({0.05, 0.8} & set(entry.fractions))


def test_without_a_calibration_signal_there_is_no_contest(settings, twin_file):
    job = settings.contest_job | {"calibrated": ["sine-010hz"]}
    with pytest.raises(InputError, match="no signal to choose a step size on"):
        hold_contest(read_twins([twin_file])[0], job)


def entry(signal, model, mse):
    about = ("gma", "gpi", "LMS", "held-out", signal, model)
    return Entry(*about, (0.1,), {"mu": 0.1}, False, mse, 1)


def test_ranking_by_hand():
    entries = [
        entry("a", "gpo", 1.0),
        entry("a", "delayed", 4.0),
        entry("b", "gpo", 3.0),
        entry("b", "delayed", 2.0),
        entry("c", "gpo", math.inf),
        entry("c", "delayed", math.inf),
    ]
    published = {(s, m): v for s in "abc" for m, v in (("gpo", 1.0), ("delayed", 2.0))}
    (found,) = rank(entries, published)
    assert (found.signals, found.gpo_first) == (3, 1)
    # on c both diverged: neither is first, and they have no order
    assert found.not_first == {"b": "delayed", "c": "none"}
    assert (found.pairs, found.pairs_as_published) == (3, 1)
    assert found.mean["gpo"] == math.inf
