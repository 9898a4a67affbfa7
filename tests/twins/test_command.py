"""The commands of the calibration, as the workflow calls them."""

import json

import numpy as np
import pytest
from click.testing import CliRunner

from hystbench.commands.jobs.calibrate import calibrate
from hystbench.commands.jobs.found import found
from hystbench.files import read_json
from hystbench.model import load_model
from hystbench.settings import read_settings
from hystbench.twins import calibrate as fitting
from hystbench.twins.calibrate import nearest_twin
from hystbench.twins.plant import UNKNOWNS, make_twin, values_of
from tests.conftest import SCHEMA, own_config, refused, shorten
from tests.conftest import table as rows_of


@pytest.fixture
def job():
    """The project's own settings on short records of two signals."""
    config = own_config()
    shorten(config, 0.1)
    config["calibration"] |= {"starts": 2, "twins": 2}
    job = read_settings(config, SCHEMA).calibration_job
    job["signals"] = {
        name: job["signals"][name] for name in ("sine-080hz", "sine-100hz")
    }
    return job


@pytest.fixture
def starts(monkeypatch):
    """Where each descent began, each cut down to one step."""
    begun = []

    def short(problem, aims, start, evaluations):
        begun.append(dict(start))
        return nearest_twin(problem, aims, start, evaluations=2)

    monkeypatch.setattr(fitting, "nearest_twin", short)
    return begun


VALUES = {item.name: item.start for item in UNKNOWNS}


def table(folder, *models):
    words = [*(str(folder / model) for model in models), "--out"]
    done = CliRunner().invoke(found, [*words, str(folder / "found.csv")])
    assert done.exit_code == 0, done.output
    return rows_of(folder / "found.csv")


def call(job, out):
    words = ["--settings", json.dumps(job), "--out", str(out)]
    return CliRunner().invoke(calibrate, words)


def test_a_calibration_writes_the_twin_and_prints_what_the_config_needs(
    job, starts, tmp_path
):
    done = call(job, tmp_path)
    assert done.exit_code == 0, done.output
    assert len(starts) == 2 * 2 + 1  # two descents a start, and the best one's last
    report = read_json(tmp_path / "report.json")
    mu = report["convergence_factor"]["gpo"]["mu"]
    assert f"config.yaml: filters: convergence_factor: gpo: mu: {mu:.6g}\n" in (
        done.stdout
    )
    for key in ("input_zero_error", "input_noise"):
        assert f"config.yaml: twin: {key}: {report[key]:.6g}\n" in done.stdout
    twin = load_model(tmp_path / "gma.yaml")
    offset = report["values"]["offset"]
    assert twin.value("calibration-error.offset") == pytest.approx(offset)
    like = [load_model(path) for path in sorted(tmp_path.glob("uncertainty/*.yaml"))]
    assert [twin.name, *(each.name for each in like)] == ["gma", "gma-01", "gma-02"]
    assert like[0].chain != like[1].chain
    assert np.isfinite(report["cells"]["rms"]["sine-080hz"])


def test_a_held_out_signal_is_refused_in_one_line(job, tmp_path):
    job["signals"]["sine-060hz"] = job["signals"]["sine-080hz"]
    words = ("--settings", json.dumps(job), "--out", tmp_path / "out")
    said = refused("job", "calibrate", *words)
    assert said.startswith("hystbench: calibration: 'sine-060hz' is held out")
    assert not (tmp_path / "out").exists()


def test_the_order_of_the_signals_does_not_matter(job, starts, tmp_path):
    job |= {"starts": 1, "twins": 1}
    back = dict(reversed(job["signals"].items()))
    reports = []
    for name, signals in (("up", job["signals"]), ("down", back)):
        assert call(job | {"signals": signals}, tmp_path / name).exit_code == 0
        reports.append((tmp_path / name / "report.json").read_bytes())
    assert reports[0] == reports[1]


def test_the_job_holds_none_of_what_is_calibrated(job):
    assert all("convergence_factor" not in each for each in job["filters"].values())
    assert "input_zero_error" not in json.dumps(job)
    assert "input_noise" not in json.dumps(job)


def test_values_are_read_back_from_the_twin_they_made():
    read = values_of(make_twin(VALUES))
    for name, value in read.items():
        assert value == pytest.approx(VALUES[name], rel=1e-5), name
    # Step sizes and what the recorded input has are the experiment's.
    assert {name for name in VALUES if name not in read} == {
        "input zero",
        "input noise",
        *(name for name in VALUES if name.endswith(" step")),
    }


def test_the_spread_is_that_over_the_twins(tmp_path):
    make_twin(VALUES).save(tmp_path / "gma.yaml")
    make_twin(VALUES | {"gain": 80.0}).save(tmp_path / "gma-01.yaml")
    rows = {row["unknown"]: row for row in table(tmp_path, "gma.yaml", "gma-01.yaml")}
    assert (rows["gain"]["twins_low"], rows["gain"]["twins_high"]) == ("80", "94")
    assert rows["mode"]["twins_low"] == rows["mode"]["twins_high"] == "63"
