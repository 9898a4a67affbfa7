"""The commands, as the workflow calls them."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner

from hystbench.adaptive import make_filter
from hystbench.commands.jobs.constants import constants
from hystbench.commands.jobs.contest import contest
from hystbench.commands.jobs.pressure import pressure
from hystbench.commands.jobs.random_sum import random_sum
from hystbench.commands.jobs.step_sweep import step_sweep
from hystbench.commands.jobs.twin_fits import twin_fits
from hystbench.commands.jobs.twin_runs import twin_runs
from hystbench.commands.jobs.twins import twins
from hystbench.compare.constants import read_constants
from hystbench.compare.draws import read_draws
from hystbench.compare.edges import read_edges
from hystbench.compare.twins import read_holdings, read_spreads
from hystbench.errors import InputError
from hystbench.pressure.ensemble import run_ensemble
from hystbench.pressure.experiments import experiments, within_margin
from hystbench.pressure.fits import fit_rdgpi
from hystbench.pressure.report import write_twins
from hystbench.pressure.runs import draw_signals, measure_twin
from hystbench.pressure.twins import read_twins

from .conftest import SIGNALS, small_settings, write_twin


def rows(path):
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def call(command, *words):
    result = CliRunner().invoke(command, list(map(str, words)), catch_exceptions=False)
    assert result.exit_code == 0, result.output


@pytest.fixture
def two(tmp_path):
    return [write_twin(tmp_path / "one.yaml"), write_twin(tmp_path / "two.yaml", 1.5)]


def run_twins(settings, files, folder):
    """Fit, run each filter and judge, as the workflow does."""
    fits, runs = folder / "fits.json", []
    call(
        twin_fits, *files, "--settings", json.dumps(settings.twin_fits_job),
        "--out", fits,
    )  # fmt: skip
    for model in settings.filters:
        runs += ["--runs", folder / f"{model}.json"]
        job = json.dumps(settings.twin_runs_job(model))
        call(twin_runs, *files, "--fits", fits, "--settings", job, "--out", runs[-1])
    errors, claims = folder / "errors.csv", folder / "claims.csv"
    call(
        twins, *files, "--fits", fits, *runs,
        "--settings", json.dumps(settings.twins_job),
        "--errors", errors, "--claims", claims,
    )  # fmt: skip
    return errors, claims


def test_twins_in_parts_are_those_of_the_ensemble_in_one(settings, two, tmp_path):
    errors, claims = run_twins(settings, two, tmp_path)
    job = settings.ensemble_job
    whole = [
        run_ensemble(twin, job, fit_rdgpi(twin, job), 0, [1.0])
        for twin in read_twins(two)
    ]
    write_twins(whole, [], tmp_path / "whole.csv", tmp_path / "whole-claims.csv")
    assert errors.read_bytes() == (tmp_path / "whole.csv").read_bytes()
    configured = [row for row in rows(claims) if row["experiment"] == "0"]
    assert configured == rows(tmp_path / "whole-claims.csv")


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
    seeds = {(row["twin"], row["experiment"]) for row in rows(claims)}
    assert len(seeds) == 4  # each twin as configured and in one more


def test_draws_edges_and_constants_are_what_the_comparison_reads(
    settings, two, tmp_path
):
    identified = tmp_path / "identified.json"
    records = []
    (twin, _) = read_twins(two)
    job = settings.constants_job
    identified.write_text("{}")
    for name, record in measure_twin(
        twin, draw_signals(job["signals"], 0).values(), job["measure"], 0
    ).items():
        records.append(tmp_path / f"{name}.npz")
        record.save(records[-1])
    draws = tmp_path / "draws.csv"
    random = settings.random_sum_job
    call(
        random_sum, two[0], "--identified", identified,
        "--settings", json.dumps(random),
        "--draws", draws, "--readings", tmp_path / "readings.csv",
    )  # fmt: skip
    (signal,) = read_draws(draws)
    found = read_draws(draws)[signal]
    assert found.count == random["draws"]
    assert len(set(found.rms)) == found.count  # phases and noise are drawn anew
    told = rows(tmp_path / "readings.csv")
    assert {row["sines"] for row in told} == {"20", "5"}
    middle = float(told[0]["median"])
    assert middle == pytest.approx(np.median(found.rms), rel=1e-3)

    edges = tmp_path / "edges.csv"
    call(
        step_sweep, *records, "--identified", identified,
        "--settings", json.dumps(settings.step_sweep_job),
        "--edges", edges, "--points", tmp_path / "points.csv",
    )  # fmt: skip
    points = rows(tmp_path / "points.csv")
    read = read_edges(edges)
    assert any(edge.edge for edge in read)
    for edge in read:
        mine = [
            p for p in points if (p["signal"], p["model"]) == (edge.signal, edge.model)
        ]
        bad = [p for p in mine if not p["re"] or float(p["re"]) >= 1]
        if not bad:
            assert edge.edge is None
            continue
        assert edge.edge == pytest.approx(float(bad[0]["mu"]), rel=1e-3)
        good = mine[: mine.index(bad[0])]
        assert all(float(p["re"]) < 1 for p in good)

    out = tmp_path / "constants.csv"
    call(
        constants, two[0], "--identified", identified,
        "--settings", json.dumps(job), "--out", out,
    )  # fmt: skip
    ranked = read_constants(out)
    usual = [row for row in ranked if row.configured]
    assert len(usual) == 1
    assert {row.constant_tap for row in ranked} == {0.0, 1.0}
    assert all(0 <= row.gpo_first <= len(SIGNALS) for row in ranked)
    total = usual[0].pairs_calibrated[1] + usual[0].pairs_held_out[1]
    assert total == 6 * len(SIGNALS)


def test_a_filter_that_diverges_on_a_twin_goes_through_its_file(two, tmp_path):
    wild = small_settings()
    wild.config["filters"]["convergence_factor"]["gpo"]["mu"] = 1e6
    errors, _ = run_twins(wild, two, tmp_path)
    gpo = [row for row in rows(errors) if row["model"] == "gpo"]
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
    assert len(rows(errors)) == 2 * len(SIGNALS) * 5
    low, high = read_spreads(errors)["sine-100hz", "gpo", "mse"]
    # 1.5 times the displacement under the same noise: up to 2.25 times the MSE
    assert low < high < 2.3 * low
    holdings = read_holdings(claims)
    assert {h.family for found in holdings.values() for h in found} == {"gpi"}
    assert all(found[0].judged <= 4 for found in holdings.values())


def test_pressure_is_the_same_each_time_and_sums_up(settings, two, tmp_path):
    job = json.dumps(settings.pressure_job)
    for out in (tmp_path / "a", tmp_path / "b"):
        call(pressure, *two, "--settings", job, "--out", out)
    for name in ("claims.csv", "by-twin.csv", "claims.md", "summary.json"):
        text = (tmp_path / "a" / name).read_bytes()
        assert text == (tmp_path / "b" / name).read_bytes()
    parts = rows(tmp_path / "a" / "by-twin.csv")
    for row in rows(tmp_path / "a" / "claims.csv"):
        mine = [p for p in parts if (p["claim"], p["signals"]) == (row["claim"], "all")]
        # two twins, two seeds, four choices of step sizes
        assert sum(int(p["members"]) for p in mine) == int(row["members"]) == 16
        held = sum(int(p["held"]) for p in mine)
        assert float(row["on_gpi_twin"]) == held / 16
        assert row["on_other_families"] == ""
    summary = json.loads((tmp_path / "a" / "summary.json").read_text())
    assert summary["twins"] == {"gpi": 2}
    assert summary["step_choices_possible"] == 81


def test_contest_writes_every_entry_and_the_rankings(settings, two, tmp_path):
    job = json.dumps(settings.contest_job)
    call(contest, two[0], "--settings", job, "--out", tmp_path)
    entries = rows(tmp_path / "contest.csv")
    # two algorithms and four filters; two held-out signals, and four for the best
    assert len(entries) == 2 * 4 * (2 + 4)
    found = rows(tmp_path / "ranking.csv")
    assert [(r["algorithm"], r["protocol"]) for r in found] == [
        ("LMS", "held-out"),
        ("NLMS", "held-out"),
        ("LMS", "best"),
        ("NLMS", "best"),
    ]
    for row in found:
        first = [
            e
            for e in entries
            if (e["algorithm"], e["protocol"], e["model"], e["rank"])
            == (row["algorithm"], row["protocol"], "gpo", "1")
        ]
        assert len(first) == int(row["gpo_first"])
    assert "GPO first on" in (tmp_path / "contest.md").read_text()
