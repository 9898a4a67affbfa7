"""A black box explains what the input causes, and neither noise nor time."""

import dataclasses
import subprocess
import sys

import numpy as np
import pytest
from scipy.signal import lfilter

from hystbench.gap.records.black_box import PENALTIES, BlackBox, BoxInputs, ridges
from hystbench.gap.records.folds import make_folds
from tests.gap.made import compared, record, sine


def multisine(seed, amplitude=1.0, count=3000, top_hz=40):
    """Sines of random phase up to some frequency."""
    random = np.random.default_rng(seed)
    frequencies = np.linspace(1, top_hz, 12)
    phases = random.uniform(0, 2 * np.pi, 12)
    waves = [
        sine(f, count=count, phase=p) for f, p in zip(frequencies, phases, strict=True)
    ]
    return amplitude * np.sum(waves, axis=0) / 3


def smooth_memory(u):
    """A nonlinearity between two low-passes: smooth, with memory, of no name."""
    low = lfilter([0.05], [1, -0.95], u)
    return lfilter([0.2], [1, -0.8], np.tanh(2 * low) * (1 + 0.5 * u))


def fitted(residual_of, count=5, floor_rms=0.0):
    inputs = [multisine(seed, 0.6 + 0.1 * seed) for seed in range(count)]
    items = [
        compared(u, residual_of(place, u), name=f"r{place}")
        for place, u in enumerate(inputs)
    ]
    return BlackBox.fit(items, make_folds([each.record for each in items]), floor_rms)


def noise(place, count=3000):
    return np.random.default_rng(100 + place).standard_normal(count)


@pytest.mark.parametrize("count", [1, 2, 5])
def test_explains_a_smooth_nonlinearity_with_memory(count):
    box = fitted(lambda place, u: smooth_memory(u), count)
    assert box.explained_on_folds > 0.85


@pytest.mark.parametrize("count", [1, 2, 5])
def test_explains_no_white_noise(count):
    box = fitted(lambda place, u: noise(place), count)
    assert abs(box.explained_on_folds) < 0.02


def test_explains_nothing_that_only_time_explains():
    box = fitted(lambda place, u: (-1) ** place * np.linspace(-1, 1, len(u)))
    assert box.explained_on_folds < 0.02


def test_share_counts_the_power_above_the_floor():
    plain = fitted(lambda place, u: smooth_memory(u) + 0.1 * noise(place))
    above = fitted(
        lambda place, u: smooth_memory(u) + 0.1 * noise(place), floor_rms=0.1
    )
    # (before - after) is the same; only the floor is taken off what is divided by. The
    # floor is a hundredth of a power that both fits see alike.
    ratio = plain.explained_on_folds / above.explained_on_folds
    inputs = [multisine(seed, 0.6 + 0.1 * seed) for seed in range(5)]
    gaps = [smooth_memory(u) + 0.1 * noise(k) for k, u in enumerate(inputs)]
    assert ratio == pytest.approx(1 - 0.01 / np.mean(np.square(gaps)), abs=0.01)
    assert above.explained_on_folds > plain.explained_on_folds


def test_no_power_above_the_floor_has_no_share():
    box = fitted(lambda place, u: 0.1 * noise(place), floor_rms=1.0)
    assert box.explained_on_folds is None


def test_predicts_a_new_record_without_its_measured_output():
    box = fitted(lambda place, u: smooth_memory(u))
    u = multisine(77, 0.9)
    new = compared(u, smooth_memory(u))
    blind = dataclasses.replace(new.record, y=noise(5))
    predicted = box.predict(new.record, new.simulated)
    assert np.array_equal(predicted, box.predict(blind, new.simulated))
    left = np.mean((new.residual - predicted) ** 2) / np.mean(new.residual**2)
    assert left < 0.05


def test_records_of_other_sampling_rates_share_one_model():
    slow, fast = multisine(1, count=3000), multisine(2, count=3000)
    items = [
        compared(u, u**2, name=f"{dt}", dt=dt)
        for u, dt in ((slow, 0.001), (fast, 0.004), (multisine(3), 0.002))
    ]
    box = BlackBox.fit(items, make_folds([item.record for item in items]))
    assert box.explained_on_folds > 0.99


def test_says_what_lies_outside_the_fitted_records():
    box = fitted(lambda place, u: smooth_memory(u))
    assert box.outside(record(multisine(3, 0.7))) == ()
    assert box.outside(record(3 * multisine(3))) == ("amplitude", "rate")
    assert box.outside(record(5 * sine(1))) == ("amplitude",)
    assert box.outside(record(sine(200))) == ("rate",)


def test_two_fits_are_equal():
    first, second = (fitted(lambda place, u: u**3, 3) for _ in range(2))
    assert np.array_equal(first.weights, second.weights)


def test_weights_are_those_of_the_stacked_least_squares():
    random = np.random.default_rng(0)
    table, target = random.standard_normal((60, 6)), random.standard_normal(60)
    for penalty, found in zip(PENALTIES, ridges(table, target).T, strict=True):
        # ridge as plain least squares with one more row a column
        extra = np.sqrt(60 * penalty) * np.eye(6)
        expected, *_ = np.linalg.lstsq(
            np.vstack([table, extra]), np.concatenate([target, np.zeros(6)])
        )
        assert found == pytest.approx(expected, rel=1e-6, abs=1e-9)


def test_products_of_the_functions_at_the_landmarks_are_the_kernel():
    u = multisine(4, count=60)
    item = compared(u, u**2)
    signals, _ = BoxInputs.of([item], [slice(None)])
    cloud = signals.state(item, slice(None))  # fewer than landmarks: nothing is lost
    apart = np.sum((cloud[:, None] - cloud[None]) ** 2, axis=2)
    seen = signals.near_landmarks(cloud)
    assert seen @ seen.T == pytest.approx(np.exp(-apart / 5), abs=1e-6)


def test_blocks_ask_whether_it_interpolates_within_records():
    # A narrow mode: the gain at one record's frequency says nothing of the next.
    items = [
        compared(u, gain * u, name=f"{f}")
        for f, gain in ((2, 0.1), (5, -0.9), (11, 1.1), (23, -0.3), (47, 0.7))
        for u in (sine(f, count=1500),)
    ]
    records = [item.record for item in items]
    within = BlackBox.fit(items, make_folds(records, whole=False))
    beyond = BlackBox.fit(items, make_folds(records))
    assert within.explained_on_folds > 0.9
    assert beyond.explained_on_folds < 0.2


def test_a_dead_simulation_and_a_short_record_are_no_trouble():
    u = sine(20, count=120)
    item = compared(u, u**2, simulated=np.zeros(120))
    box = BlackBox.fit([item], make_folds([item.record]))
    assert np.isfinite(box.predict(item.record, item.simulated)).all()
    assert box.explained_on_folds > 0.5


def test_heavy_libraries_are_imported_late():
    code = (
        "import sys, hystbench.gap.holdout.shrink, "
        "hystbench.gap.experiment.candidates, hystbench.gap.records.black_box; "
        "print({'sklearn', 'scipy', 'matplotlib', 'jinja2'} & set(sys.modules))"
    )
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert run.stdout == "set()\n"
