"""The options of ``hystbench gap`` reach the search."""

from types import SimpleNamespace

import pytest
from click.testing import CliRunner

from hystbench.commands import gap as module
from tests.gap.tiny import write_tiny


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Run the command, the search replaced; give what it was asked."""
    data, base = write_tiny(tmp_path)
    asked = []

    content = {"verdict": "named", "effects": [], "no_experiment": "no way"}

    def close(evidence, model, out, **given):
        asked.append(given)
        return SimpleNamespace(experiment=None, content=content)

    monkeypatch.setattr(module, "close_gap", close)

    def invoke(*more):
        words = [str(data), "--model", str(base), "--out", str(tmp_path / "out"), *more]
        result = CliRunner().invoke(module.gap, words)
        assert result.exit_code == 0, result.output
        return asked[-1], result.output

    return invoke


def test_limits_of_the_next_experiment_are_those_asked_and_no_other(run):
    assert run()[0]["limits"] == {}
    asked, _ = run("--limit-low", "0", "--limit-rate", "12.5")
    assert asked["limits"] == {"low": 0.0, "rate": 12.5}
    asked, _ = run("--limit-low", "-0.5", "--limit-high", "0.75")
    assert asked["limits"] == {"low": -0.5, "high": 0.75}


def test_why_no_experiment_was_written_is_said(run, tmp_path):
    _, said = run("--write-experiment", str(tmp_path / "next.csv"))
    assert "not written: no way" in said
    assert not (tmp_path / "next.csv").exists()
