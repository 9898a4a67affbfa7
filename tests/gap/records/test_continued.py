"""A measurement that was cut in two: the second part begins where the first ends."""

import numpy as np
import pytest

from hystbench.dataset import load_dataset
from hystbench.gap.asked import Asked
from hystbench.gap.bases.load import load_base
from hystbench.gap.records.evidence import load_evidence
from hystbench.gap.run import closed_gap
from hystbench.inspection.check import check
from tests.messages import message

DT, TAU_S, NOISE, FIRST, LAST = 1.0, 120.0, 0.05, 400, 600


def heated():
    """A body of one heat capacity, with steps of its heater."""
    random = np.random.default_rng(2)
    u = np.repeat(random.uniform(10.0, 70.0, LAST // 50), 50)
    y, now = [], 0.0
    for value in u.tolist():
        y.append(now)
        now += (0.4 * value - now) * -np.expm1(-DT / TAU_S)
    return u, np.array(y) + NOISE * random.standard_normal(LAST)


@pytest.fixture(scope="module")
def signals():
    return heated()


def dataset(folder, signals, parts, *, times=None, period=None):
    """Write the measurement, and a dataset that cuts it into parts."""
    u, y = signals
    times = DT * np.arange(LAST) if times is None else times
    table = np.column_stack([times, u, y])
    header = "time_s,heater_W,temperature_degC"
    for name in {file for file, *_ in parts}:
        np.savetxt(folder / name, table, "%.9g", ",", header=header, comments="")
    entries = "".join(
        f"  - {{file: {file}, name: part-{k}, rows: [{first}, {last}], use: {use}"
        + (f", period_samples: {period}}}\n" if period else "}\n")
        for k, (file, first, last, use) in enumerate(parts)
    )
    (folder / "dataset.yaml").write_text(
        "name: heater\n"
        "time: {column: time_s, unit: s}\n"
        "input: {column: heater_W, unit: W, hold: zero-order}\n"
        "output: {column: temperature_degC, unit: degC}\n"
        f"noise_rms: {NOISE}\n"
        f"records:\n{entries}"
    )
    return folder / "dataset.yaml"


BOTH = [("run.csv", 1, FIRST, "fit"), ("run.csv", FIRST + 1, LAST, "hold-out")]


def test_the_part_that_is_held_out_has_the_other_before_it(tmp_path, signals):
    evidence = load_evidence(dataset(tmp_path, signals, BOTH))
    (fit,), (held,) = evidence.fit, evidence.hold_out
    assert (len(fit), fit.past) == (FIRST, 0)
    assert (len(held), held.past, held.lead) == (LAST, FIRST, FIRST)
    np.testing.assert_allclose(held.u, signals[0], rtol=1e-8)
    assert np.count_nonzero(held.counted) == LAST - FIRST
    assert len(held.as_measured) == LAST - FIRST


def test_a_base_of_long_memory_is_as_right_there_as_where_it_was_fitted(
    tmp_path, signals
):
    """From rest it would be as many degrees off as the body is warm."""
    evidence = load_evidence(dataset(tmp_path, signals, BOTH))
    base, _ = load_base("linear", evidence)
    found = closed_gap(evidence, base, Asked())
    assert found.outcome.content["gap"]["before"] < 1.3 * NOISE
    (table,) = found.outcome.outputs
    assert len(table[0]) == LAST - FIRST


@pytest.mark.parametrize(
    "parts",
    [
        # Nothing of what is held out comes into what is fitted.
        [("run.csv", 1, 200, "hold-out"), ("run.csv", 201, LAST, "fit")],
        # A sample between them is missing, or it is another measurement.
        [("run.csv", 1, FIRST, "fit"), ("run.csv", FIRST + 2, LAST, "hold-out")],
        [("run.csv", 1, FIRST, "fit"), ("other.csv", FIRST + 1, LAST, "hold-out")],
    ],
)
def test_others_stay_as_they_are(parts, tmp_path, signals):
    evidence = load_evidence(dataset(tmp_path, signals, parts))
    assert [record.past for record in (*evidence.fit, *evidence.hold_out)] == [0, 0]


@pytest.mark.parametrize("between", [0.0, 1.4, 2.0, 1e4])
def test_the_clock_has_to_go_on(between, tmp_path, signals):
    """A sample is missing, or another run begins."""
    times = DT * np.arange(LAST)
    times[FIRST:] += between - DT
    where = dataset(tmp_path, signals, BOTH, times=times)
    (held,) = load_evidence(where).hold_out
    assert held.past == (FIRST if between == 1.4 else 0)


def switched_off(signals):
    """Give the signals with a heater that stands from before the cut on."""
    u, y = signals
    return np.where(np.arange(LAST) < FIRST - 50, u, 25.0), y


def test_an_input_may_stand_where_it_moved_just_before(tmp_path, signals):
    where = dataset(tmp_path, switched_off(signals), BOTH)
    (held,) = load_evidence(where).hold_out
    assert held.past == FIRST
    assert np.ptp(held.u) > 0 == np.ptp(held.as_measured.u)
    found = check(load_dataset(where), effects=False)
    assert found.facts[1].input.kind == "steps"


def test_an_input_that_stands_by_itself_is_refused_by_its_rows(tmp_path, signals):
    apart = [("run.csv", 1, FIRST, "fit"), ("run.csv", FIRST + 2, LAST, "hold-out")]
    where = dataset(tmp_path, switched_off(signals), apart)
    said = message(lambda: load_evidence(where))
    assert f"record part-1 (rows {FIRST + 2} to {LAST}): column 'heater_W'" in said
    times = DT * np.arange(LAST)
    times[FIRST:] += 1e4
    where = dataset(tmp_path, switched_off(signals), BOTH, times=times)
    said = message(lambda: load_evidence(where))
    assert f"record part-1 (rows {FIRST + 1} to {LAST})" in said
    assert "the time does not go on" in said


def test_a_period_that_still_warms_up_has_what_was_before(tmp_path):
    """A steady one has the same period before it."""
    u = np.tile(np.repeat([20.0, 60.0], 50), LAST // 100)
    warm = 50.0 * -np.expm1(-np.arange(LAST) / 300.0) + 0.1 * u
    where = dataset(tmp_path, (u, warm), BOTH, period=100)
    (held,) = load_evidence(where).hold_out
    assert (held.past, held.period_samples) == (FIRST, None)
    steady = 0.1 * u + NOISE * np.random.default_rng(5).standard_normal(LAST)
    where = dataset(tmp_path, (u, steady), BOTH, period=100)
    (held,) = load_evidence(where).hold_out
    assert (held.past, held.period_samples) == (0, 100)


def test_samples_that_were_not_measured_stay_so(tmp_path, signals):
    u, y = signals
    y = y.copy()
    y[[100, 500]] = np.nan
    where = dataset(tmp_path, (u, y), BOTH)
    where.write_text(where.read_text().replace("use:", "missing: interpolate, use:"))
    (held,) = load_evidence(where).hold_out
    assert np.flatnonzero(held.interpolated).tolist() == [100, 500]


def test_of_overlapping_parts_the_longest_past_counts(tmp_path, signals):
    parts = [*BOTH, ("run.csv", 300, FIRST, "fit")]
    (held,) = load_evidence(dataset(tmp_path, signals, parts)).hold_out
    assert held.past == FIRST


def test_of_three_parts_the_last_has_both_before_it(tmp_path, signals):
    three = [
        ("run.csv", 1, 200, "fit"),
        ("run.csv", 201, FIRST, "fit"),
        ("run.csv", FIRST + 1, LAST, "hold-out"),
    ]
    (held,) = load_evidence(dataset(tmp_path, signals, three)).hold_out
    assert held.past == FIRST
