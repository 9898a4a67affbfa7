"""The trial of structures: fair starts, and nothing that remembers."""

from dataclasses import replace
from functools import partial

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.calibration.crossvalidation import leave_one_out
from hystbench.calibration.fit import to_point
from hystbench.calibration.structures import (
    STRUCTURES,
    find_structure,
    make_objective,
)
from hystbench.calibration.targets import targets
from hystbench.calibration.trial import search, starts, try_structure

from .trial_job import SIGNALS, job

names = st.sampled_from([item.name for item in STRUCTURES])
seeds = st.integers(0, 2**32 - 1)


@given(names, st.integers(1, 6), seeds)
def test_starts_lie_within_the_bounds(name, count, seed):
    structure = find_structure(name)
    found = starts(structure, count, seed)
    assert len(found) == count
    for values in found:
        point = to_point(values, structure.unknowns)
        assert ((point >= 0) & (point <= 1)).all()


@given(names, seeds)
def test_structures_differ_in_their_starts_by_what_sets_them_apart(name, seed):
    structure = find_structure(name)
    own = {item.name for item in structure.more}
    for ours, base in zip(
        starts(structure, 3, seed), starts(find_structure("base"), 3, seed), strict=True
    ):
        shared = (set(ours) & set(base)) - own
        assert {k: ours[k] for k in shared} == {k: base[k] for k in shared}


def test_the_first_start_is_the_middle_of_the_bounds():
    structure = find_structure("base")
    point = to_point(starts(structure, 1, seed=1)[0], structure.unknowns)
    assert point == pytest.approx(0.5)


def test_a_fit_knows_nothing_of_the_signal_left_out():
    """Another table for the signal left out changes its errors, not the fit."""
    job_ = job(starts=2, evaluations=2, last_evaluations=2)
    objective = make_objective(find_structure("base"), job_)
    points = starts(find_structure("base"), 2, seed=1)
    find = partial(search, objective, points, job_["budget"])
    fits = {}

    def kept(which, others):
        fit = find(others)
        fits[which, others[0].signal] = fit
        return fit

    truth = targets(SIGNALS)
    first = truth[0]
    other = (
        replace(first, mse={m: 9 * v for m, v in first.mse.items()}, rms=first.rms / 2),
        truth[1],
    )
    left = {}
    for which, aims in (("truth", truth), ("other", other)):
        left[which] = leave_one_out(objective, aims, partial(kept, which))
    # Without the first signal the same fit; without the second another one.
    assert fits["truth", SIGNALS[1]] == fits["other", SIGNALS[1]]
    assert fits["truth", SIGNALS[0]] != fits["other", SIGNALS[0]]
    for model, ratio in left["truth"][0].log10_ratio.items():
        told = left["other"][0].log10_ratio[model]
        assert ratio - told == pytest.approx(0.954243, abs=1e-6)  # log10 of 9


def test_more_descents_end_no_higher():
    job_ = job()
    structure = find_structure("base")
    objective = make_objective(structure, job_)
    aims = targets(SIGNALS)
    points = starts(structure, 3, seed=1)
    budget = {"evaluations": 3, "last_evaluations": 1}
    one, three = (search(objective, points[:n], budget, aims) for n in (1, 3))
    assert three.cost <= one.cost
    residuals = objective.residuals(three.values, aims)
    assert three.cost == pytest.approx(residuals @ residuals / 2)


@pytest.mark.parametrize("name", ["base", "identified-envelopes"])
def test_what_is_kept_of_a_trial_is_so(name):
    job_ = job()
    told = []
    found = try_structure(find_structure(name), job_, tell=told.append)
    assert found["name"] == name
    assert [one["signal"] for one in found["left_out"]] == list(SIGNALS)
    assert len(told) == 1 + len(SIGNALS)
    objective = make_objective(find_structure(name), job_).at(found["values"])
    residuals = objective.residuals(found["values"], targets(SIGNALS))
    assert found["cost"] == pytest.approx(residuals @ residuals / 2)
    # Of all residuals of the cells left out, by the definition that the page gives.
    scales = {"gpo": 0.06, "backlash": 0.10, "volterra": 0.08, "delayed": 0.08}
    expected = 0.0
    for one, aim in zip(found["left_out"], targets(SIGNALS), strict=True):
        for model, ratio in one["log10_ratio"].items():
            doubt = 1.0 if aim.consistent[model] else 0.5
            expected += (1 + (doubt * ratio / scales[model]) ** 2) ** 0.5 - 1
    assert found["score"] == pytest.approx(expected)
