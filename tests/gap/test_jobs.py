"""The jobs around naming: what they read, what they write, the tables of all."""

from __future__ import annotations

import csv
import json
import shutil

import pytest

from hystbench.errors import InputError
from hystbench.gap import run
from hystbench.gap.asked import Asked
from hystbench.gap.effects import effects
from hystbench.gap.example import slow_loop_model
from hystbench.gap.records.evidence import load_evidence
from hystbench.gap.report.tables import (
    write_adds,
    write_table,
)
from hystbench.gap.stages import BASE_FILE, DECISION_FILE, decide_in, show_in
from hystbench.gap.vocabulary import Vocabulary
from hystbench.model import Model, load_model
from hystbench.record import Channel
from tests.gap.closing import close_gap
from tests.gap.tiny import BASE, LAG_S, LATE, write_tiny


@pytest.fixture(scope="module")
def decided(tmp_path_factory):
    """A folder in which the verdict was given while hold-out records were garbage."""
    folder = tmp_path_factory.mktemp("jobs")
    data, base = write_tiny(folder)
    kept = (data / "unseen.csv").read_bytes()
    (data / "unseen.csv").write_text("no record\n")
    with pytest.raises(InputError, match="unseen"):
        load_evidence(data)
    out = folder / "out"
    decide_in(out, load_evidence(data, "fit"), load_model(base), Asked(vocabulary=LATE))
    (data / "unseen.csv").write_bytes(kept)
    return folder, data, base, out


def rows(path):
    with path.open(newline="") as stream:
        return list(csv.DictReader(stream))


def test_nothing_of_hold_out_records_is_read_to_decide(decided, tmp_path):
    _, data, base, out = decided
    show_in(out, load_evidence(data), load_model(base))
    evidence, model = load_evidence(data), load_model(base)
    close_gap(evidence, model, tmp_path, report=False, vocabulary=LATE)
    for file in ("gap.json", "model.yaml", "curves.json", "holdout/unseen.csv"):
        assert (out / file).read_bytes() == (tmp_path / file).read_bytes(), file


def test_the_search_is_given_no_record_that_is_held_out(decided, monkeypatch):
    class SearchedError(Exception):
        pass

    def search(evidence, *_):
        assert evidence.fit
        assert evidence.hold_out == ()
        raise SearchedError

    monkeypatch.setattr(run, "search_and_judge", search)
    _, data, base, out = decided
    with pytest.raises(SearchedError):
        close_gap(load_evidence(data), load_model(base), out)


def test_effects_left_out_and_put_in_are_those_of_one_run(decided, tmp_path):
    _, data, base, _ = decided
    kept = {"drive-lag", "eddy-diffusion", "asymmetry"}
    without = sorted(set(effects()) - kept)
    vocabulary = Vocabulary.of(without, ["asymmetry"])
    asked = Asked(vocabulary=vocabulary)
    model = load_model(base)
    decide_in(tmp_path / "jobs", load_evidence(data, "fit"), model, asked)
    begun = load_model(tmp_path / "jobs" / BASE_FILE)
    assert begun.name == "tiny-base with asymmetry"
    show_in(tmp_path / "jobs", load_evidence(data), begun)
    all_of_it, one = load_evidence(data), tmp_path / "one"
    close_gap(all_of_it, model, one, report=False, vocabulary=vocabulary)
    for file in ("gap.json", "model.yaml", "curves.json"):
        made = [(tmp_path / way / file).read_bytes() for way in ("jobs", "one")]
        assert made[0] == made[1], file
    content = json.loads((tmp_path / "jobs" / "gap.json").read_text())
    assert set(content["asked"]["without"]) == set(without)
    assert content["built_in"]["effects"][0]["name"] == "asymmetry"


def test_showing_changes_nothing_that_was_decided(decided, tmp_path):
    _, data, base, out = decided
    content = json.loads((out / DECISION_FILE).read_text())
    noise = shutil.copytree(data, tmp_path / "noise")
    lines = (noise / "unseen.csv").read_text().splitlines()
    cells = [line.split(",") for line in lines[1:]]
    reversed_outputs = [row[2] for row in reversed(cells)]
    text = [
        f"{t},{u},{y}" for (t, u, _), y in zip(cells, reversed_outputs, strict=True)
    ]
    (noise / "unseen.csv").write_text("\n".join([lines[0], *text]) + "\n")
    other = shutil.copytree(out, tmp_path / "other")
    show_in(other, load_evidence(noise), load_model(base))
    shown = json.loads((other / "gap.json").read_text())
    for key in ("verdict", "ranking", "where", "next_experiment"):
        assert shown[key] == content[key]
    # Laws that other records do not bear out are no surer than even; no more moves.
    for now, decided in zip(shown["effects"], content["effects"], strict=True):
        assert now["confidence"] <= decided["confidence"]
        assert now == decided | {"confidence": now["confidence"]}
    # Outputs backward in time fit no model.
    assert shown["gap"]["after"] > 10 * shown["gap"]["noise_floor"]


def test_tables_hold_what_gap_json_holds(decided, tmp_path):
    _, data, base, out = decided
    show_in(out, load_evidence(data), load_model(base))
    content = json.loads((out / "gap.json").read_text())
    write_table("summary", [content, content], tmp_path / "summary.csv")
    write_table("effects", [content], tmp_path / "effects.csv")
    one, other = rows(tmp_path / "summary.csv")
    assert one == other
    assert (one["dataset"], one["verdict"], one["effects"]) == (
        "tiny",
        "named",
        "drive-lag",
    )
    for key in ("before", "after", "noise_floor"):
        assert float(one[key]) == pytest.approx(content["gap"][key], rel=1e-3)
    write_table("records", [content], tmp_path / "records.csv")
    (record,) = rows(tmp_path / "records.csv")
    assert (record["record"], record["outside"]) == ("unseen", "")
    assert float(record["before"]) == pytest.approx(content["gap"]["before"], rel=1e-3)
    assert float(record["after"]) == pytest.approx(content["gap"]["after"], rel=1e-3)
    assert float(record["black_box"]) == pytest.approx(
        content["black_box"]["after"], rel=1e-3
    )
    (parameter,) = rows(tmp_path / "effects.csv")
    assert parameter["parameter"] == "time_constant_s"
    assert float(parameter["value"]) == pytest.approx(LAG_S, rel=0.02)


def test_what_a_model_adds_leaves_its_hysteresis_out(tmp_path):
    chain = [*BASE["chain"], {"sensor-lag": {"time_constant_s": 0.25}}]
    write_adds(Model.from_mapping(BASE | {"chain": chain}, "m"), tmp_path / "adds.csv")
    assert rows(tmp_path / "adds.csv") == [
        {
            "block": "sensor-lag",
            "parameter": "time_constant_s",
            "value": "0.25",
            "unit": "s",
        }
    ]


@pytest.mark.parametrize("offset", [0.0, -0.5])
def test_the_slow_loop_becomes_a_model_with_its_offset(offset):
    identified = {
        **BASE["chain"][0]["gpi"],
        "offset": offset,
        "start": "rest",
    }
    given, measured = Channel("current", "A"), Channel("displacement", "um")
    model = slow_loop_model(identified, given, measured)
    plain = Model.from_mapping(BASE, "base")
    assert model.chain[0] == plain.chain[0]
    assert [block.name for block in model.chain[1:]] == ["gain"] * (offset != 0)
    if offset:
        assert model.value("gain.offset") == offset
