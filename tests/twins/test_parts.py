"""The claims on several twins, in parts, as the workflow makes them."""

import json
from dataclasses import replace

import numpy as np
import pytest

from hystbench.adaptive import make_filter, run_filter
from hystbench.commands.jobs.twin_fits import twin_fits
from hystbench.commands.jobs.twin_runs import twin_runs
from hystbench.commands.jobs.twins import twins
from hystbench.compare.beside import read_holdings, read_spreads
from hystbench.errors import InputError
from hystbench.twins.fits import fit
from hystbench.twins.parts import experiments, join, run, within_margin
from hystbench.twins.runs import draw_signals, measure_twin, read_twins
from tests.conftest import table

from .conftest import SIGNALS, call, small_settings


def run_twins(settings, files, folder):
    """Fit, run each filter and judge, as the workflow does."""
    fits, runs = folder / "fits.json", []
    call(
        twin_fits, *files, "--settings", json.dumps(settings.twin_fits_job),
        "--out", fits,
    )  # fmt: skip
    for model in settings.filters:
        runs += ["--run", folder / f"{model}.json"]
        job = json.dumps(settings.twin_runs_job(model))
        call(twin_runs, *files, "--fits", fits, "--settings", job, "--out", runs[-1])
    errors, claims = folder / "errors.csv", folder / "claims.csv"
    call(
        twins, *files, "--fits", fits, *runs,
        "--settings", json.dumps(settings.twins_job),
        "--errors", errors, "--claims", claims,
    )  # fmt: skip
    return errors, claims


def test_runs_are_those_of_the_pipeline(settings, two, tmp_path):
    errors, _ = run_twins(settings, two, tmp_path)
    found = {(r["twin"], r["signal"], r["model"]): r for r in table(errors)}
    job = settings.twins_job
    for twin in read_twins(two):
        signals = draw_signals(job["signals"], 0).values()
        for name, record in measure_twin(twin, signals, job["measure"], 0).items():
            for model in settings.filters:
                own = settings.filter_job(model)
                kept, _ = run_filter(make_filter(model, own, record), record, own)
                for metric in ("mse", "re"):
                    ran = float(found[twin.name, name, model][metric])
                    assert ran == pytest.approx(kept[metric], rel=1e-12)


def test_evidence_holds_what_each_part_found(settings, two):
    twins = read_twins(two)
    fitted = fit(twins, settings.twin_fits_job)
    ran = [run(twins, settings.twin_runs_job(m), fitted) for m in settings.filters]
    configured, other = join(twins[0], 0, settings.twins_job, [fitted, *ran])
    assert (configured.experiment.seed, other.experiment.seed) == (0, 1)
    evidence = configured.evidence
    assert list(evidence.records) == SIGNALS
    assert ("sine-100hz", "rdgpi") in evidence.runs
    assert {p.model for p in evidence.order_sweep} == set(settings.filters)
    assert len(evidence.envelope_errors) == 2 * len(SIGNALS)
    # config.yaml has the published envelopes
    published = evidence.envelope_errors["sine-100hz", "published"]
    assert published == evidence.runs["sine-100hz", "gpo"].mse
    assert other.evidence.order_sweep == evidence.order_sweep


def test_a_seed_is_another_draw_of_noise_and_of_the_random_sum(settings, twin_file):
    job, twin = settings.twins_job, read_twins([twin_file])[0]
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


def test_other_experiments_change_what_they_say(settings, two, tmp_path):
    """Another seed, zero error, noise and step sizes, each filter within its margin."""
    job = settings.twins_job
    (one, other) = experiments(job["experiments"] | {"members": 2}, 0)
    assert one.seed != other.seed
    assert experiments(job["experiments"] | {"members": 2}, 1)[0].seed not in (
        one.seed,
        other.seed,
    )
    measured = replace(one, zero=-1.0, noise=2.0).measured(job["measure"])
    assert measured["input_zero_error"] == -job["measure"]["input_zero_error"]
    assert measured["input_noise"] == 2 * job["measure"]["input_noise"]
    gpo = settings.filter_job("gpo")
    (twin, _) = read_twins(two)
    signals = draw_signals(job["signals"], 0).values()
    record = measure_twin(twin, signals, job["measure"], 0)["sine-100hz"]
    for factor in (0.5, 2.0, 100.0):
        chosen = within_margin("gpo", gpo, factor, [record], {})
        adaptive = make_filter("gpo", chosen, record)
        most = adaptive.correction(adaptive.largest_power(record.u))
        wanted = factor * gpo["convergence_factor"]["mu"]
        assert most <= 1.7 * (1 + 1e-12)
        assert adaptive.step_size <= wanted
        assert most == pytest.approx(1.7) or adaptive.step_size == wanted
    _, claims = run_twins(settings, two, tmp_path)
    seeds = {(row["twin"], row["experiment"]) for row in table(claims)}
    assert len(seeds) == 4  # each twin as configured and in one more


def test_a_filter_that_diverges_on_a_twin_goes_through_its_file(two, tmp_path):
    wild = small_settings()
    wild.config["filters"]["convergence_factor"]["gpo"]["mu"] = 1e6
    errors, _ = run_twins(wild, two, tmp_path)
    gpo = [row for row in table(errors) if row["model"] == "gpo"]
    assert gpo
    for row in gpo:
        assert (row["mse"], row["re"]) == ("", "")
        assert row["status"].startswith("diverged at sample")


def test_a_twin_that_was_not_fitted_is_told(settings, two, tmp_path):
    fits = tmp_path / "fits.json"
    job = json.dumps(settings.twin_fits_job)
    call(twin_fits, two[0], "--settings", job, "--out", fits)
    with pytest.raises(InputError, match=r"two\.yaml: not run; expected one of one"):
        call(
            twin_runs, two[1], "--fits", fits,
            "--settings", json.dumps(settings.twin_runs_job("delayed")),
            "--out", tmp_path / "out.json",
        )  # fmt: skip


def test_twins_writes_what_the_comparison_reads(settings, two, tmp_path):
    errors, claims = run_twins(settings, two, tmp_path)
    assert len(table(errors)) == 2 * len(SIGNALS) * 5
    low, high = read_spreads(errors)["sine-100hz", "gpo", "mse"]
    # 1.5 times the displacement under the same noise: up to 2.25 times the MSE
    assert low < high < 2.3 * low
    holdings = read_holdings(claims)
    assert {h.family for found in holdings.values() for h in found} == {"gpi"}
    assert all(found[0].judged <= 4 for found in holdings.values())
