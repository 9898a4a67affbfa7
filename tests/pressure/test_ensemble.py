"""The ensemble against runs made one by one, and its draws."""

import numpy as np
import pytest

from hystbench.adaptive import make_filter, run_filter
from hystbench.pressure.ensemble import run_ensemble, step_choices
from hystbench.pressure.fits import fit_rdgpi
from hystbench.pressure.runs import draw_signals, measure_twin, scaled
from hystbench.pressure.twins import read_twins

from .conftest import SIGNALS

FILTERS = ["gpo", "backlash", "volterra", "delayed"]


@pytest.fixture
def ensemble(settings, twin_file):
    job, twin = settings.ensemble_job, read_twins([twin_file])[0]
    return run_ensemble(twin, job, fit_rdgpi(twin, job), seed=0, factors=[0.5, 1.0])


def test_runs_are_those_of_the_pipeline(settings, ensemble):
    records = ensemble.common.records
    assert list(records) == SIGNALS
    for model in FILTERS:
        job = settings.filter_job(model)
        for name, record in records.items():
            adaptive = make_filter(model, job, record)
            kept, _ = run_filter(adaptive, record, job)
            run = ensemble.runs[model, 1.0][name, model]
            assert run.mse == pytest.approx(kept["mse"], rel=1e-12)
            assert run.re == pytest.approx(kept["re"], rel=1e-12)
            assert run.step_size == kept["step_size"]


def test_evidence_takes_the_runs_of_each_filters_factor(ensemble):
    mixed = dict.fromkeys(FILTERS, 1.0) | {"delayed": 0.5}
    evidence = ensemble.evidence(mixed)
    for model, factor in mixed.items():
        for signal in SIGNALS:
            run = evidence.runs[signal, model]
            assert run is ensemble.runs[model, factor][signal, model]
    assert ("sine-100hz", "rdgpi") in evidence.runs
    assert {p.model for p in evidence.order_sweep} == set(FILTERS)
    assert len(evidence.envelope_errors) == 2 * len(SIGNALS)
    published = evidence.envelope_errors["sine-100hz", "published"]
    assert published == evidence.runs["sine-100hz", "gpo"].mse


def test_half_the_step_size_is_half_of_each(settings):
    job = scaled(settings.filter_job("volterra"), 0.5)
    whole = settings.filter_job("volterra")["convergence_factor"]
    assert job["convergence_factor"] == {k: v / 2 for k, v in whole.items()}


def test_a_filter_beyond_its_bound_diverges_and_is_kept(settings, twin_file):
    job, twin = settings.ensemble_job, read_twins([twin_file])[0]
    wild = run_ensemble(twin, job | {"rdgpi": None}, None, 0, [1e3])
    run = wild.runs["delayed", 1e3]["sine-100hz", "delayed"]
    assert run.mse is None
    assert run.diverged.startswith("diverged at sample")


def test_a_seed_is_another_draw_of_noise_and_of_the_random_sum(settings, twin_file):
    job, twin = settings.ensemble_job, read_twins([twin_file])[0]
    first, other = (
        measure_twin(twin, draw_signals(job["signals"], s).values(), job["measure"], s)
        for s in (0, 1)
    )
    sine, random = "sine-100hz", "multisine-random-0-100hz"
    # two draws of a noise differ by sqrt(2) times as much
    rms = {"u": job["measure"]["input_noise"], "y": 0.02}
    for name, each in rms.items():
        difference = getattr(first[sine], name) - getattr(other[sine], name)
        assert difference.std() == pytest.approx(each * 2**0.5, rel=0.1)
    assert np.abs(first[random].u - other[random].u).max() > 0.1


def test_choices_are_all_where_they_are_few_and_seeded_where_not():
    every = step_choices(["gpo", "delayed"], [0.5, 1.0, 2.0], 9, [1])
    assert len(every) == 9
    assert {(c["gpo"], c["delayed"]) for c in every} == {
        (a, b) for a in (0.5, 1.0, 2.0) for b in (0.5, 1.0, 2.0)
    }
    some = step_choices(FILTERS, [0.5, 1.0, 2.0], 12, [1, 2])
    assert len({tuple(c.values()) for c in some}) == 12
    assert some == step_choices(FILTERS, [0.5, 1.0, 2.0], 12, [1, 2])
    assert some != step_choices(FILTERS, [0.5, 1.0, 2.0], 12, [1, 3])
