"""The commands, as the workflow calls them."""

import csv
import json

import pytest
from click.testing import CliRunner

from hystbench.commands.contest import contest
from hystbench.commands.pressure import pressure
from hystbench.commands.twins import twins
from hystbench.compare.twins import read_holdings, read_spreads

from .conftest import SIGNALS, write_twin


def rows(path):
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def call(command, *words):
    result = CliRunner().invoke(command, list(map(str, words)), catch_exceptions=False)
    assert result.exit_code == 0, result.output


@pytest.fixture
def two(tmp_path):
    return [write_twin(tmp_path / "one.yaml"), write_twin(tmp_path / "two.yaml", 1.5)]


def test_twins_writes_what_the_comparison_reads(settings, two, tmp_path):
    errors, claims = tmp_path / "errors.csv", tmp_path / "claims.csv"
    job = json.dumps(settings.ensemble_job)
    call(twins, *two, "--settings", job, "--errors", errors, "--claims", claims)
    assert len(rows(errors)) == 2 * len(SIGNALS) * 5
    low, high = read_spreads(errors)["sine-100hz", "gpo", "mse"]
    # 1.5 times the displacement under the same noise: up to 2.25 times the MSE
    assert low < high < 2.3 * low
    holdings = read_holdings(claims)
    assert {h.family for found in holdings.values() for h in found} == {"gpi"}
    assert all(found[0].judged <= 2 for found in holdings.values())


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
