"""``hystbench job held-out``: no figure before a choice, and what the figures are."""

import csv
import json

import numpy as np
import pytest

from hystbench.calibration.structures import find_structure
from hystbench.calibration.trial import starts
from hystbench.commands.jobs import held_out as command
from hystbench.commands.jobs.held_out import held_out
from hystbench.errors import InputError
from hystbench.files import write_json
from hystbench.signals import sine
from tests.calibration.trial_job import job


@pytest.fixture
def call(tmp_path):
    def run(name, settings, *tried):
        for one in tried:
            write_json(tmp_path / f"{one['name']}.json", one)
        choice = tmp_path / "choice.yaml"
        choice.write_text(f"chosen: {{name: {name}}}\n")
        words = [str(tmp_path / f"{one['name']}.json") for one in tried]
        words += ["--settings", json.dumps(settings), "--choice", str(choice)]
        out = tmp_path / "held-out.csv"
        held_out.main([*words, "--out", str(out)], standalone_mode=False)
        with out.open(newline="") as stream:
            return list(csv.DictReader(stream))

    return run


def one(name, score=1.0):
    return {
        "name": name,
        "score": score,
        "values": starts(find_structure(name), 1, 1)[0],
    }


def test_a_choice_that_was_not_tried_is_refused(call, tmp_path):
    with pytest.raises(InputError, match="'crep' was not tried"):
        call("crep", {}, one("creep"))
    assert not (tmp_path / "held-out.csv").exists()


def test_a_choice_that_is_not_committed_is_refused(call, tmp_path, monkeypatch):
    def refuse(path, tell):
        raise InputError(f"{path.name}: not committed as it is")

    monkeypatch.setattr(command, "check_committed", refuse)
    with pytest.raises(InputError, match=r"choice\.yaml: not committed"):
        call("creep", {}, one("creep"))
    assert not (tmp_path / "held-out.csv").exists()


def test_the_figures_are_those_of_the_records(call, monkeypatch):
    monkeypatch.setattr(command, "check_committed", lambda path, tell: None)
    settings = job()
    common = settings["signals"]["sine-080hz"]["common"]
    settings["signals"] = {
        "sine-120hz": {"definition": {"sine": {"frequency_hz": 120}}, "common": common}
    }
    rows = call("base", settings, one("base", 2.0), one("creep", 1.0))
    assert [row["structure"] for row in rows] == ["creep", "base"]
    assert [row["chosen"] for row in rows] == ["", "yes"]
    quiet = one("base")["values"]
    u = sine(
        frequency_hz=120, amplitude=0.632, duration_s=0.2, sampling_frequency_hz=10_000
    )
    # Without the sensor's noise, whose square adds to that of the displacement.
    y = find_structure("base").make(quiet).simulate(u, 1e-4)
    rms = np.sqrt(np.mean(y**2) + quiet["noise"] ** 2)
    # 120 Hz of Table 1: 7.354 to 7.361 um from MSE and RE.
    expected = 100 * (rms / 7.3575 - 1)
    told = float(rows[1]["rms_percent_sine-120hz"])
    assert told == pytest.approx(expected, abs=0.2)
    assert float(rows[1]["held_out_rms_percent"]) == abs(told)
