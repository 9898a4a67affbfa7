"""Plain fits of one effect find what is hidden, and what is within the noise."""

import numpy as np
import pytest

from hystbench.challenge.case import make_case
from hystbench.challenge.spec import CaseSpec
from hystbench.plain_fits import Task, effects, fit, within_noise
from tests.entrants.test_rivals import LEFT_OUT, SPEC


@pytest.fixture(scope="module")
def case():
    return make_case(SPEC)


def test_every_effect_of_the_vocabulary_can_be_fitted(case):
    records = [r for r in case.records if r.use == "fit"][:2]
    task = Task(case.model, records)
    base = float(np.mean((task.base - task.measured) ** 2))
    found = {name: fit(task, name) for name in effects()}
    assert len(found) == 22
    assert [name for name, item in found.items() if item is None] == ["hysteresis"]
    # a fit of squares with the base inside its bounds, or at them, is no worse
    for name in ("thermal-drift", "creep", "calibration-error", "drift"):
        assert found[name].mean_square <= base


@pytest.mark.parametrize("effect", ["sensor-lag", "stiffness-hardening"])
def test_a_plain_fit_finds_what_is_hidden(effect):
    case = make_case(CaseSpec(150_002, "single", (effect,), "gpi", 20.0, **LEFT_OUT))
    records = [r for r in case.records if r.use == "fit"]
    found = fit(Task(case.model, records), effect)
    # the noise, and at most a tenth of the effect's power
    gap = case.truth["effects"][0]["rms"] ** 2
    assert found.mean_square <= case.truth["noise_rms"] ** 2 + 0.1 * gap


def test_a_set_of_the_judge_holds_what_mimics_and_not_what_does_not(case):
    records = [r for r in case.records if r.use == "fit"]
    noise = case.truth["noise_rms"]
    names = ("thermal-drift", "backlash", "no-effect-at-all")
    given = (case.model, records, names, "thermal-drift", noise**2, noise)
    assert within_noise(*given) == ("thermal-drift",)
    # where anything is within the noise, all that can be fitted is
    loud = (*given[:-1], 1e3)
    assert within_noise(*loud) == ("thermal-drift", "backlash")
