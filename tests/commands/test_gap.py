"""The options of ``hystbench gap`` reach the search."""

from types import SimpleNamespace

import numpy as np
import pytest
import yaml
from click.testing import CliRunner

from hystbench.commands import gap as module
from hystbench.commands.simulate import simulate
from hystbench.dataset import load_dataset
from hystbench.files import read_json
from hystbench.gap import run as run_module
from hystbench.signals import load_signal
from tests.conftest import own_config
from tests.gap.made import CURRENT
from tests.gap.small import write_lagging
from tests.gap.tiny import write_tiny


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Run the command, the search replaced; give what it was asked."""
    data, base = write_tiny(tmp_path)
    asked = []

    decision = SimpleNamespace(experiment=None, content={"no_experiment": "no way"})
    found = SimpleNamespace(
        closed=SimpleNamespace(decision=decision),
        effects=(),
        verdict="named",
        content={
            "reason": "the gap is closed",
            "withdrawn": None,
            "warnings": ["a late word"],
        },
        save=lambda out, report: None,
    )

    def find(dataset, model, **given):
        asked.append(given)
        return found

    monkeypatch.setattr(module, "find_gap", find)

    def invoke(*more, withdrawn=None):
        found.content["withdrawn"] = withdrawn
        words = [str(data), "--model", str(base), "--out", str(tmp_path / "out"), *more]
        result = CliRunner().invoke(module.gap, words)
        assert result.exit_code == 0, result.output
        return asked[-1], result.output

    return invoke


def test_a_warning_of_the_hold_out_records_is_shown_at_the_end(run):
    _, said = run()
    assert said.count("hystbench: warning: a late word") == 1
    assert said.index("a late word") < said.index("the gap is closed")


def test_the_line_by_which_it_enters_the_contest_is_understood(run):
    program, command, *words = own_config()["blind"]["solvers"]["gap"]["command"]
    assert (program, command) == ("hystbench", "gap")
    given = ("{dataset}", "--model", "{model}", "--out", "{out}")
    assert tuple(words[: len(given)]) == given
    run(*words[len(given) :])


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


def test_the_last_line_tells_what_was_taken_back(run):
    _, said = run(withdrawn={"names": ["drive-lag", "creep"]})
    last = said.splitlines()[-1]
    assert last.endswith("named (the hold-out records took drive-lag, creep back)")
    _, said = run(withdrawn={"names": []})
    assert said.splitlines()[-1].endswith(": named")


LIMITS = {"low": -0.15, "high": 0.35, "rate": 12.0}


@pytest.fixture(scope="module")
def lagging(tmp_path_factory):
    """A gain whose output lags: a lag of the drive would do as well."""
    folder = tmp_path_factory.mktemp("lagging")
    write_lagging(folder)
    return folder


def invoked(folder, out, *more):
    words = [str(folder / "rig"), "--model", str(folder / "base.yaml")]
    words += ["--out", str(out), "--no-report", *more]
    for name, value in LIMITS.items():
        words.append(f"--limit-{name}={value}")
    result = CliRunner().invoke(module.gap, words)
    assert result.exit_code == 0, result.output
    return result.output


def kept(u, dt):
    assert u.min() >= LIMITS["low"] - 1e-6
    assert u.max() <= LIMITS["high"] + 1e-6
    assert np.abs(np.diff(u)).max() <= LIMITS["rate"] * dt * (1 + 1e-4)
    assert np.ptp(u) > 0.1 * (LIMITS["high"] - LIMITS["low"])


def test_the_signal_file_is_a_record_once_its_output_is_measured(lagging, tmp_path):
    """Read by the reader of datasets: the column is the input's of the dataset."""
    file = tmp_path / "next.csv"
    said = invoked(lagging, tmp_path / "out", "--write-experiment", str(file))
    content = read_json(tmp_path / "out" / "gap.json")
    assert content["effects"][0]["cannot_be_told_from"]
    assert content["next_experiment"]["sentence"] in said
    header, *rows = file.read_text().splitlines()
    measured = [f"{row},{12.5 * float(row.split(',')[1])}" for row in rows]
    (tmp_path / "rig").mkdir()
    table = "\n".join([f"{header},displacement_um", *measured])
    (tmp_path / "rig" / "next.csv").write_text(table + "\n")
    about = yaml.safe_load((lagging / "rig" / "dataset.yaml").read_text())
    about["records"] = [{"file": "next.csv", "use": "fit"}]
    (tmp_path / "rig" / "dataset.yaml").write_text(yaml.safe_dump(about))
    found = load_dataset(tmp_path / "rig").read("next")
    assert found.input == CURRENT
    assert found.dt == pytest.approx(content["next_experiment"]["sampling_interval_s"])
    kept(found.u, found.dt)


def test_the_signal_archive_runs_a_model(lagging, tmp_path):
    file = tmp_path / "next.npz"
    invoked(lagging, tmp_path / "out", "--write-experiment", str(file))
    signal = load_signal(file)
    assert signal.unit == CURRENT.unit
    kept(signal.u, signal.dt)
    words = [str(tmp_path / "out" / "model.yaml"), str(file)]
    result = CliRunner().invoke(simulate, [*words, "--out", str(tmp_path / "y.csv")])
    assert result.exit_code == 0, result.output
    table = np.loadtxt(tmp_path / "y.csv", delimiter=",", skiprows=1)
    assert table[:, 1] == pytest.approx(signal.u)


@pytest.mark.parametrize("option", ["--out", "--write-experiment"])
def test_where_nothing_can_be_written_no_search_is_paid(
    lagging, tmp_path, option, monkeypatch
):
    def find(*given):
        raise AssertionError

    monkeypatch.setattr(run_module, "search_and_judge", find)
    (tmp_path / "taken").write_text("mine")
    words = [str(lagging / "rig"), "--model", str(lagging / "base.yaml")]
    places = {"--out": "out", "--write-experiment": "next.csv"} | {option: "taken/x/y"}
    for name, place in places.items():
        words += [name, str(tmp_path / place)]
    result = CliRunner().invoke(module.gap, words)
    assert "taken: a file; expected a folder" in str(result.exception)
    assert [item.name for item in tmp_path.iterdir()] == ["taken"]
