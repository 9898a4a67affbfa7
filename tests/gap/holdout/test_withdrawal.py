"""Hold-out records choose nothing, and take back what is worse on them."""

import json

import numpy as np
import pytest

from hystbench.gap.asked import Asked
from hystbench.gap.holdout.withdraw import (
    first_figure,
    rms_of_a_constant,
    withdrawal,
    without_names,
    worse_than_a_constant,
)
from hystbench.gap.records.evidence import Evidence, load_evidence
from hystbench.gap.report.words import verdict_sentence
from hystbench.gap.schema import SCHEMA
from hystbench.gap.stages import DECISION_FILE, decide_in, show_in
from hystbench.model import Model, load_model
from hystbench.schema import check_against_schema
from tests.gap.closing import close_gap
from tests.gap.made import record
from tests.gap.tiny import BASE, LATE, write_driven, write_tiny


def content(before=1.0, after=0.5, verdict="named", names=("creep",), **gap):
    return {
        "verdict": verdict,
        "unit": "um",
        "effects": [{"name": name} for name in names],
        "gap": {"before": before, "after": after, "noise_floor": 0.1, "explained": 0.8}
        | gap,
        "records": [{"name": "a", "before": before, "after": after, "explained": 0}],
        "runs_away": [{"record": "a"}] if after is None else [],
    }


@pytest.mark.parametrize(
    ("verdict", "names"),
    [
        ("named", ("creep",)),
        ("unnamed", ("creep", "backlash")),
        ("parameters", ()),
        ("unnamed", ()),
    ],
)
def test_what_is_worse_than_the_base_goes_whatever_the_verdict_was(verdict, names):
    def taken(after):
        return withdrawal(content(1.0, after, verdict, names))

    assert taken(0.5) is None
    assert taken(1.0) is None
    assert taken(1.004) is None  # less power than may stay unnamed
    for after in (1.02, 30.0, None):
        found = taken(after)
        assert found["names"] == list(names)
        assert (found["before"], found["after"]) == (1.0, after)
        assert " and ".join(names) in found["why"]
    assert "from 1 to 30 um rms" in taken(30.0)["why"]


def test_it_must_not_be_worse_than_the_first_base_either():
    """A hysteresis that was identified again leaves more: the effect is not in it."""
    assert withdrawal(content(1.0, 0.5), 0.6) is None
    found = withdrawal(content(1.0, 0.5), 0.4)
    assert found["before"] == 0.4
    assert "from 0.4 to 0.5 um rms" in found["why"]


def test_where_there_is_no_gap_the_base_goes_back_to_what_it_was():
    """Re-tuned it does worse; that says nothing of a gap."""
    given = content(1.0, 2.0, "no-gap", ()) | {"reason": "noise"}
    numbers = {"gain.value": {"before": 1.0, "after": 3.0}}
    found = without_names(given | {"base_parameters": numbers}, withdrawal(given))
    assert (found["verdict"], found["reason"]) == ("no-gap", "noise")
    assert found["base_parameters"] == {"gain.value": {"before": 1.0, "after": 1.0}}
    assert found["withdrawn"]["names"] == []


@pytest.mark.parametrize(
    ("names", "reason"), [((), "no effect pays; "), (("creep",), "")]
)
def test_what_was_found_stands_before_a_re_tuning_that_is_taken_back(names, reason):
    """A reader is to learn that there was no name to be taken back."""
    given = content(1.0, 2.0, "unnamed", names) | {"reason": "no effect pays"}
    taken = withdrawal(given)
    found = without_names(given | {"base_parameters": {}}, taken)
    assert found["reason"] == reason + taken["why"]


def test_the_first_figure_says_of_what_it_is_a_share():
    said = first_figure(content(2.0, 1.0))
    assert said == (
        "on the hold-out records 80.0 % of the gap's power above the noise floor is "
        "gone, 2 to 1 um rms"
    )
    assert "46.0 % to 54.0 %" in first_figure(content(explained=[0.46, 0.54]))
    assert "%" not in first_figure(content(explained=None))
    assert "none of the gap's power" in first_figure(content(explained=-0.001))
    # Less power than may stay unnamed is above the noise: a share of it says nothing.
    assert "no more than noise" in first_figure(content(1.0, 1.0, noise_floor=0.999))


def test_a_base_that_a_constant_beats_on_hold_out_records_is_told():
    """The fit records' mean is 3; on the hold-out record it leaves 1."""
    u = np.zeros(4)
    fit = record(u, [2.0, 4.0, 2.0, 4.0], name="a")
    held = record(u, [4.0, 2.0, 4.0, 2.0], name="b", use="hold-out")
    evidence = Evidence("rig", (fit,), (held,))
    still = rms_of_a_constant(evidence, 0.1)
    assert still == 1.0
    (told,) = worse_than_a_constant(1.5, still, "um")
    assert "leaves 1.5 um rms, and a constant" in told
    assert " 1 um" in told
    assert worse_than_a_constant(0.9, still, "um") == []
    # As much noise would leave of a record at rest.
    assert worse_than_a_constant(1.5, rms_of_a_constant(evidence, 1.0), "um") == []


def spoilt(tmp_path, name, spoil):
    """Write the tiny device with nothing hidden, one record of it spoilt."""
    data, base = write_tiny(tmp_path)
    rng = np.random.default_rng(1)
    for file in sorted(data.glob("*.csv")):
        table = np.loadtxt(file, delimiter=",", skiprows=1)
        model = Model.from_mapping(BASE, "base")
        table[:, 2] = model.simulate(table[:, 1], table[1, 0])
        table[:, 2] += 0.02 * rng.standard_normal(len(table))
        if file.stem == name:
            spoil(table)
        np.savetxt(file, table, "%.9g", ",", header="time_s,current_A,displacement_um")
        file.write_text(file.read_text().removeprefix("# "))
    out = tmp_path / "out"
    close_gap(load_evidence(data), load_model(base), out, report=False, vocabulary=LATE)
    return json.loads((out / "gap.json").read_text())


def test_no_gap_is_not_said_where_the_base_predicts_nothing(tmp_path):
    def swapped(table):
        table[:, [1, 2]] = table[:, [2, 1]]

    found = spoilt(tmp_path, "unseen", swapped)
    assert found["verdict"] == "unnamed"
    assert "as it is, the model predicts nothing" in found["reason"]
    assert found["reason"].count("of the fit records: ") == 1


def test_a_base_that_predicts_nothing_is_no_warning_where_the_model_does(tmp_path):
    """The drive is 7 ms late: half a period of 70 Hz, which turns its sign."""
    late = 35

    def drive(u):
        return np.concatenate([np.full(late, u[0]), u[:-late]])

    data, base = write_driven(tmp_path, drive)
    out = tmp_path / "out"
    close_gap(load_evidence(data), load_model(base), out, report=False, vocabulary=LATE)
    found = json.loads((out / "gap.json").read_text())
    assert [item["name"] for item in found["effects"]] == ["input-delay"]
    still = rms_of_a_constant(load_evidence(data), found["gap"]["noise_floor"])
    assert found["gap"]["before"] > 1.05 * still > 10 * found["gap"]["after"]
    assert not [text for text in found["warnings"] if "predicts nothing" in text]


def test_lone_samples_are_told_with_their_place(tmp_path):
    def glitch(table):
        table[200:203, 2] += 30.0

    (told,) = spoilt(tmp_path, "unseen", glitch)["warnings"]
    assert "left on the hold-out records" in told
    assert "unseen (3 samples from " in told
    assert "'missing: interpolate'" in told


@pytest.fixture(scope="module")
def misled(tmp_path_factory):
    """The drive of the fit records lags, that of the hold-out record does not."""
    folder = tmp_path_factory.mktemp("misled")
    data, base = write_tiny(folder)
    file = data / "unseen.csv"
    table = np.loadtxt(file, delimiter=",", skiprows=1)
    table[:, 2] = Model.from_mapping(BASE, "base").simulate(table[:, 1], table[1, 0])
    table[:, 2] += 0.02 * np.random.default_rng(1).standard_normal(len(table))
    np.savetxt(file, table, "%.9g", ",", header="time_s,current_A,displacement_um")
    file.write_text(file.read_text().removeprefix("# "))
    evidence, out = load_evidence(data), folder / "out"
    close_gap(evidence, load_model(base), out, report=False, vocabulary=LATE)
    return folder, data, base, json.loads((folder / "out" / "gap.json").read_text())


def test_a_name_is_withdrawn_where_the_gap_grows(misled):
    folder, _, base, found = misled
    check_against_schema(found, SCHEMA, "gap.json")
    assert (found["verdict"], found["effects"]) == ("unnamed", [])
    taken = found["withdrawn"]
    assert (taken["verdict"], taken["names"]) == ("named", ["drive-lag"])
    assert taken["after"] > 2 * taken["before"]
    assert [step["rms"] for step in found["ladder"]] == pytest.approx(
        [taken["before"], taken["after"]], rel=1e-3
    )
    # All that is said now is of the model that was written: the base.
    assert found["gap"]["after"] == found["gap"]["before"]
    assert load_model(folder / "out" / "model.yaml").chain == load_model(base).chain
    table = np.loadtxt(folder / "out/holdout/unseen.csv", delimiter=",", skiprows=1)
    assert np.array_equal(table[:, 2], table[:, 3])


def test_the_page_says_so_first(misled):
    assert "Drive lag was withdrawn" in verdict_sentence(misled[-1])


def test_jobs_take_back_what_one_process_does(misled, tmp_path):
    """The job that decides knows no hold-out record: it wrote the name."""
    folder, data, base, _ = misled
    asked = Asked(vocabulary=LATE)
    decide_in(tmp_path, load_evidence(data, "fit"), load_model(base), asked)
    decided = json.loads((tmp_path / DECISION_FILE).read_text())
    assert (decided["verdict"], len(decided["effects"])) == ("named", 1)
    assert not (tmp_path / "model.yaml").exists()
    show_in(tmp_path, load_evidence(data), load_model(base))
    for file in ("gap.json", "model.yaml", "holdout/unseen.csv"):
        assert (tmp_path / file).read_bytes() == (folder / "out" / file).read_bytes()
