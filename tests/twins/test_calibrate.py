"""Calibration: what it may see, what it minimises, and that it finds a known twin."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.adaptive import make_filter
from hystbench.errors import InputError
from hystbench.filters import MOST_CORRECTION
from hystbench.model import load_model
from hystbench.published.split import CALIBRATION_SIGNALS
from hystbench.settings import read_settings
from hystbench.signals import Signal, make_signal
from hystbench.twins import calibrate as fitting
from hystbench.twins.calibrate import calibrate, nearest_twin
from hystbench.twins.constraints import check_stroke, turns, violations
from hystbench.twins.ensemble import equally_good
from hystbench.twins.objective import Objective, error_residual
from hystbench.twins.plant import (
    STEP_NAMES,
    UNKNOWNS,
    make_twin,
    step_sizes,
    values_of,
    weights,
)
from hystbench.twins.search import Fit, to_point, to_values
from hystbench.twins.targets import Target, targets
from hystbench.waveforms.chirp import Chirp
from hystbench.waveforms.sine import Sine
from tests.conftest import ROOT, SCHEMA, own_config

START = {item.name: item.start for item in UNKNOWNS} | {"gpo step": 1.5}
COMMON = {"order": 30, "input_before": 0.0, "constant_tap": 0.0, "amplitude": 0.632}
PLAYS = {**COMMON, "initial_state": "zero", "convergence_factor": {"mu": 1.0}}
TWO = {"first_order": 1.0, "second_order": 1.0}
FILTERS = {
    "gpo": {**PLAYS, "operator_form": "eq12", "envelopes": "published"},
    "backlash": {**PLAYS, "backlash_structure": "delay-line"},
    "volterra": {**COMMON, "convergence_factor": TWO},
    "delayed": {**COMMON, "convergence_factor": {"mu": 1.0}},
}
HELD_OUT = (
    "sine-060hz",
    "sine-120hz",
    "sine-200hz",
    "chirp-1-100hz",
    "multisine-random-0-100hz",
)


def objective(names=("sine-040hz", "sine-100hz"), duration_s=0.1):
    signals = {
        name: Signal(
            name,
            1e-4,
            Sine.samples(
                frequency_hz=float(name[5:8]),
                amplitude=0.632,
                duration_s=duration_s,
                sampling_frequency_hz=10_000,
            ),
            "A",
        )
        for name in names
    }
    return Objective(signals, FILTERS, seed=1)


def targets_of(problem, values):
    cells = problem.cells(values, problem.signals)
    consistent = dict.fromkeys(FILTERS, True)
    return tuple(
        Target(name, cells.mse[name], cells.rms[name], consistent)
        for name in problem.signals
    )


@pytest.mark.parametrize("name", HELD_OUT)
def test_a_held_out_signal_is_refused(name):
    with pytest.raises(InputError, match=f"'{name}' is held out or unknown"):
        targets([name])


def test_targets_are_those_of_the_tables():
    found = {target.signal: target for target in targets()}
    assert tuple(found) == CALIBRATION_SIGNALS
    # Table 1, and sqrt(MSE) / RE of its rows by hand.
    assert found["sine-150hz"].mse == {
        "gpo": 0.0157,
        "backlash": 0.1163,
        "volterra": 0.0224,
        "delayed": 0.2514,
    }
    assert found["sine-010hz"].rms == pytest.approx(0.4248**0.5 / 0.0711, rel=1e-3)
    # GPO and Volterra imply 5.06 and 4.73 um here, backlash and delayed 4.88 um.
    five = found["multisine-5-25-50-75-100hz"]
    assert five.consistent["backlash"]
    assert not five.consistent["gpo"]
    assert five.rms == pytest.approx(4.884, abs=0.002)


@given(st.lists(st.floats(0, 1), min_size=len(UNKNOWNS), max_size=len(UNKNOWNS)))
def test_places_and_values_are_each_others_inverse(point):
    np.testing.assert_allclose(
        to_point(UNKNOWNS, to_values(UNKNOWNS, np.array(point))), point, atol=1e-9
    )


def test_weights_are_a_share_for_the_first_and_an_exponential():
    w = weights(gain=62.0, first=0.5, decay=0.0)
    assert w[0] == pytest.approx(31.0)
    np.testing.assert_allclose(w[1:], 31.0 / 30)
    w = weights(gain=70.0, first=0.2, decay=3.1)
    assert w.sum() == pytest.approx(70.0)
    np.testing.assert_allclose(w[2:] / w[1:-1], np.exp(-0.1))


def test_a_small_residual_is_the_deviation_and_a_large_one_grows_less():
    target = Target("s", {"gpo": 1.0}, 1.0, {"gpo": True})
    assert error_residual("gpo", 1.0, target) == 0.0
    assert error_residual("gpo", 10**0.006, target) == pytest.approx(0.1, rel=1e-2)
    far = error_residual("gpo", 10**6.0, target)
    # r^2 / 2 = sqrt(1 + 100^2) - 1
    assert far**2 / 2 == pytest.approx(np.sqrt(1 + 1e4) - 1)
    doubted = dataclasses.replace(target, consistent={"gpo": False})
    assert error_residual("gpo", 10**0.006, doubted) == pytest.approx(0.05, rel=1e-2)


def test_turns_are_those_of_the_peak_to_peak_displacement():
    model = make_twin({**START, "participation": -0.05, "damping": 0.03})
    dt = 1e-4
    u = Chirp.samples(
        from_hz=1,
        to_hz=100,
        amplitude=0.632,
        duration_s=2.03,
        sampling_frequency_hz=1 / dt,
    )
    y = model.simulate(u, dt)
    # Extremes of each half period, by the sign of the slope; hysteresis included.
    places = np.flatnonzero(np.diff(np.sign(np.diff(y)))) + 1
    times = (places[1:] + places[:-1]) / 2 * dt
    sizes = np.abs(np.diff(y[places]))
    near = (times > 1.0) & (times < 1.65)
    times, sizes = times[near], sizes[near]
    found = turns(model)
    top = np.argmax(sizes * (times > 1.28))
    assert found.greatest_s == pytest.approx(times[top], abs=0.02)
    assert found.least_s == pytest.approx(times[np.argmin(sizes[:top])], abs=0.02)


def test_a_mode_elsewhere_violates_the_chirp():
    excess = violations(make_twin({**START, "mode": 60.0, "damping": 0.01}))
    assert excess["chirp greatest (s)"] > 0
    with pytest.raises(InputError, match="31 um; expected within the stroke of 30 um"):
        check_stroke("sine", np.array([0.0, -31.0]))


def test_a_step_size_alone_gives_the_same_residuals_as_the_whole():
    problem = objective()
    aims = targets_of(problem, {**START, "gain": 60.0})
    changed = {**START, "delayed step": 0.05}
    whole = problem.residuals(changed, aims)
    alone = problem.step_residuals(changed, aims, "delayed")
    place = list(FILTERS).index("delayed")
    # Errors by signal and filter, RMS by signal, margins by filter.
    rows = [*(i * 4 + place for i in range(len(aims))), len(aims) * 5 + place]
    np.testing.assert_array_equal(whole[rows], alone)


def test_a_filter_beyond_its_margin_costs_and_one_within_it_does_not():
    problem = objective()
    aims = targets_of(problem, START)
    names = [aim.signal for aim in aims]
    told = problem.corrections(START, "gpo", names)
    mu = START["gpo step"]
    # 2 mu max|H|^2, H of the filter itself.
    for name, most in told.items():
        adaptive = make_filter(
            "gpo",
            {**FILTERS["gpo"], "convergence_factor": {"mu": mu}},
            problem._records[name],
        )
        line = np.r_[np.zeros(adaptive.history), problem._records[name].u]
        rows, _ = adaptive.regressor(line, np.zeros(31))
        assert most == pytest.approx(2 * mu * np.max(np.sum(rows**2, axis=1)))
    at = mu * MOST_CORRECTION / max(told.values())
    margins = slice(len(aims) * 5, len(aims) * 5 + 4)
    for factor, free in ((0.999, True), (1.01, False)):
        values = {**START, "gpo step": factor * at}
        residuals = problem.residuals(values, aims)[margins]
        assert (residuals[0] == 0) == free
        assert residuals[1:] == pytest.approx(0)
        excesses = problem.excesses(values, aims)
        assert (excesses["stability margin of gpo"] <= 0) == free


def test_the_committed_twin_keeps_the_margin_on_every_calibration_signal():
    config = own_config()
    job = read_settings(config, SCHEMA).calibration_job
    signals = {
        name: make_signal(name, **job["signals"][name]) for name in CALIBRATION_SIGNALS
    }
    problem = Objective(signals, job["filters"], job["seed"])
    values = values_of(load_model(ROOT / "src/hystbench/plants/gma.yaml"))
    steps = config["filters"]["convergence_factor"]
    for model, names in STEP_NAMES.items():
        values |= {unknown: steps[model][key] for key, unknown in names.items()}
    values["input zero"] = config["twin"]["input_zero_error"]
    values["input noise"] = config["twin"]["input_noise"]
    problem.cells(values, signals)
    for model in STEP_NAMES:
        for name, most in problem.corrections(values, model, signals).items():
            assert most <= 1.7 + 1e-3, (model, name)
    # None of what the twin is made of stands at an end of what the search allows.
    places = dict(
        zip([item.name for item in UNKNOWNS], to_point(UNKNOWNS, values), strict=True)
    )
    assert {name for name, place in places.items() if not 0.01 < place < 0.99} == set()


def test_descent_finds_a_twin_that_made_the_targets():
    problem = objective()
    truth = {**START, "gain": 91.0, "backlash step": 0.15, "offset": -0.15}
    aims = targets_of(problem, truth)
    before = problem.residuals(START, aims)
    fit = nearest_twin(problem, aims, START, evaluations=20)
    assert fit.cost < 1e-2 * (before @ before) / 2
    found = problem.cells(fit.values, problem.signals)
    for aim in aims:
        for model, mse in aim.mse.items():
            assert found.mse[aim.signal][model] == pytest.approx(mse, rel=0.1)


def test_the_best_of_several_starts_goes_on(monkeypatch):
    costs = iter([9.0, 3.0, 9.0, 1.0, 9.0, 2.0])  # near and tuned, of three starts
    begun = []

    def near(problem, aims, start, evaluations):
        begun.append(dict(start))
        return Fit(dict(START) | {"gain": float(len(begun))}, next(costs, 0.5))

    monkeypatch.setattr(fitting, "nearest_twin", near)
    monkeypatch.setattr(fitting, "tune_steps", lambda problem, aims, values: values)
    monkeypatch.setattr(Objective, "excesses", lambda *_: {})
    told = []
    best = calibrate(objective(), (), starts=3, seed=1, tell=told.append)
    assert told == [
        "start 1 of 3: cost 3",
        "start 2 of 3: cost 1",
        "start 3 of 3: cost 2",
        "finished: cost 0.5",
    ]
    assert begun[0] == pytest.approx(
        {item.name: item.start for item in UNKNOWNS}
    )  # the stated start, and others around it
    assert begun[2] != pytest.approx(begun[0])
    assert begun[-1]["gain"] == 4.0  # where the second start's tuned descent ended
    assert best.cost == 0.5


def test_a_twin_that_breaks_a_constraint_is_refused(monkeypatch):
    broken = {**START, "mode": 60.0, "damping": 0.01}
    monkeypatch.setattr(fitting, "nearest_twin", lambda *a, **k: Fit(broken, 1.0))
    monkeypatch.setattr(fitting, "tune_steps", lambda problem, aims, values: values)
    with pytest.raises(InputError, match=r"'chirp \w+ \(s\)' is exceeded by"):
        calibrate(objective(), (), starts=1, seed=1)


def test_step_sizes_are_named_as_in_the_config():
    assert step_sizes(START) == {
        name: {key: START[unknown] for key, unknown in names.items()}
        for name, names in fitting.STEP_NAMES.items()
    }
    assert set(step_sizes(START)["volterra"]) == {"first_order", "second_order"}


def test_equally_good_twins_keep_their_promise():
    problem = objective()
    truth = {**START, "gain": 90.0, "mode": 64.2, "damping": 0.012}
    # Targets that no twin meets: some cost is left for others to be as good as.
    aims = tuple(
        dataclasses.replace(aim, mse={k: 1.3 * v for k, v in aim.mse.items()})
        for aim in targets_of(problem, truth)
    )
    best = nearest_twin(problem, aims, truth, evaluations=6)
    twins = equally_good(problem, aims, best, count=3, seed=1)
    assert len({twin.cost for twin in twins}) == 3
    shared = {"input zero", "input noise"}
    shared |= {name for name in START if name.endswith(" step")}
    for name, value in best.values.items():
        values = [twin.values[name] for twin in twins]
        assert (np.ptp([*values, value]) < 1e-9) == (name in shared)
    for twin in twins:
        residuals = problem.residuals(twin.values, aims)
        assert twin.cost == pytest.approx(residuals @ residuals / 2)
        assert twin.cost <= 1.1 * best.cost
        assert max(violations(make_twin(twin.values)).values()) <= 1e-3


def test_tuned_steps_are_no_worse_and_reach_another_valley():
    problem = objective()
    aims = targets_of(problem, START)
    off = {**START, "delayed step": START["delayed step"] / 3}
    tuned = fitting.tune_steps(problem, aims, off)
    assert tuned["delayed step"] == pytest.approx(START["delayed step"])
    assert {k: v for k, v in tuned.items() if k != "delayed step"} == {
        k: v for k, v in START.items() if k != "delayed step"
    }
