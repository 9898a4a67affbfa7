"""An answer is judged against the truth: right, false alarm, spurious, withdrawn."""

import dataclasses

import pandas as pd
import pytest

from hystbench.challenge.contest.score import write_rows
from hystbench.challenge.contest.tables import confusion, frame, read_rows, write_frame
from hystbench.challenge.where import share_held, where_hit
from hystbench.errors import InputError

from .made import (
    AMPLITUDE,
    BRANCH,
    DELAY,
    FREQUENCY,
    TIME,
    effect,
    gap,
    judged,
    named,
    truth,
    view,
)

RIGHT = gap(named("resonance"), views=[view()])


def test_a_right_answer():
    row = judged(truth(effect()), RIGHT)
    assert (row.top1, row.in_set, row.exact, row.all_named) == (True,) * 4
    assert (row.where_hit, row.set_size, row.confidence) == (True, 1, 0.9)
    assert (row.false_alarm, row.unnamed, row.lost) == (None, None, "")
    # noise 3 and base error 4: 25 of 169 cannot go; 169 - 25 = 144 can, and did
    assert row.shrink == pytest.approx(1.0)
    assert (row.ratio_db, row.ratio_retuned_db) == (20.0, 18.0)


@pytest.mark.parametrize(
    ("name", "place", "right"),
    [
        ("friction", "inside", True),
        ("friction", "beside", True),
        ("friction", "mechanics", False),
        # another name in the right place
        ("hysteretic-force", "inside", True),
    ],
)
def test_the_place_in_a_machine(name, place, right):
    hidden = effect("friction", "coulomb", where=[]) | {"place": "inside"}
    told = named(name) | {"place": place}
    row = judged(truth(hidden, family="impedance"), gap(told))
    assert row.place_right is right
    assert row.top1 is (name == "friction")
    assert row.where_hit is None
    unnamed = judged(truth(hidden, family="impedance"), gap(verdict="unnamed"))
    assert unnamed.place_right is False
    assert judged(truth(effect()), RIGHT).place_right is None


def test_half_a_gap_closed():
    # 169 - 97 = 72 of 144
    row = judged(truth(effect()), gap(named("resonance"), after=97**0.5))
    assert row.shrink == pytest.approx(0.5)


def test_a_model_that_runs_away_closes_nothing():
    row = judged(truth(effect()), gap(named("resonance"), after=None))
    assert (row.shrink, row.top1, row.lost) == (0.0, True, "")


def test_a_spurious_effect_beside_the_right_one():
    row = judged(truth(effect()), gap(named("resonance"), named("creep")))
    assert (row.top1, row.exact, row.all_named) == (True, False, True)


def test_the_right_effect_second():
    row = judged(truth(effect()), gap(named("creep"), named("resonance")))
    assert (row.top1, row.in_set, row.exact) == (False, False, False)


def test_a_set_counts_only_what_the_judge_confirms():
    about = truth(effect())
    content = gap(named("creep", ties=["resonance", "drift"]))
    asked = []

    def confirm(names):
        asked.append(names)
        return ("creep",)

    row = judged(about, content, confirm)
    assert asked == [("creep", "resonance", "drift")]
    assert (row.in_set, row.in_set_raw) == (False, True)
    assert (row.set_size, row.set_size_raw) == (1, 3)


@pytest.mark.parametrize("family", ["gpi", "preisach"])
def test_the_shape_beside_a_foreign_plant_is_neither_required_nor_spurious(family):
    content = gap(named("hysteresis-shape"), named("resonance"))
    row = judged(truth(effect(), family=family), content)
    let_pass = family == "preisach"
    assert (row.top1, row.exact) == (let_pass, let_pass)
    assert (row.top1_strict, row.exact_strict) == (False, False)
    assert judged(truth(effect(), family=family), RIGHT).exact


@pytest.mark.parametrize(
    ("family", "content", "alarm", "strict"),
    [
        ("gpi", gap(verdict="no-gap"), False, False),
        ("gpi", gap(named("hysteresis-shape")), True, True),
        ("preisach", gap(named("hysteresis-shape")), False, True),
        ("preisach", gap(named("hysteresis-shape"), named("creep")), True, True),
        ("preisach", gap(verdict="unnamed"), True, True),
        ("gpi", gap(verdict="parameters"), True, True),
    ],
)
def test_false_alarms(family, content, alarm, strict):
    row = judged(truth(kind="none", family=family), content)
    assert (row.false_alarm, row.false_alarm_strict) == (alarm, strict)
    assert (row.top1, row.shrink, row.where_hit) == (None, None, None)


def test_outside_the_vocabulary_only_unnamed_is_right():
    about = truth(effect("dropouts", "only"), kind="unlisted")
    row = judged(about, gap(verdict="unnamed"))
    assert (row.unnamed, row.exact, row.top1, row.all_named) == (True, True, None, None)
    # the shape beside what is unnamed is a name all the same
    assert not judged(about, gap(named("hysteresis-shape"), verdict="unnamed")).exact
    assert judged(about, RIGHT).unnamed is False


def test_names_beside_the_verdict_unnamed_name_nothing():
    content = gap(named("resonance", ties=["creep"]), verdict="unnamed")
    row = judged(truth(effect()), content)
    assert (row.top1, row.top1_strict, row.in_set, row.in_set_raw) == (False,) * 4
    assert (row.all_named, row.exact, row.set_size) == (False, False, None)
    about = truth(effect(), effect("creep", "one-element"), kind="pair")
    both = gap(named("creep"), named("resonance"), verdict="unnamed")
    assert judged(about, both).all_named is False
    assert [item[2] for item in confusion(frame([row]))] == ["unnamed"]


def test_names_that_were_withdrawn_name_nothing():
    effects = gap(named("resonance"))["effects"]
    taken = {
        "names": ["resonance"],
        "verdict": "named",
        "effects": effects,
        "before": 1.0,
        "after": 2.0,
        "records": [],
        "why": "worse there",
    }
    content = gap(verdict="unnamed") | {"withdrawn": taken}
    row = judged(truth(effect()), content)
    assert (row.lost, row.verdict, row.top1, row.exact) == ("", "unnamed", False, False)
    foreign = judged(truth(effect("dropouts", "only"), kind="unlisted"), content)
    assert (foreign.unnamed, foreign.exact) == (True, True)


def test_a_missing_item_of_a_list_is_not_compared():
    true = {"magnitudes": [0.1, 0.2]}
    about = truth(effect("creep", "one-element", true))
    row = judged(about, with_creep([0.1, None], [0.01, None]))
    assert (row.lost, row.parameters, row.intervals) == ("", 1, 1)


def test_pairs():
    about = truth(effect(), effect("creep", "one-element"), kind="pair")
    both = judged(about, gap(named("creep"), named("resonance")))
    assert (both.all_named, both.exact, both.top1) == (True, True, None)
    assert judged(about, RIGHT).all_named is False


def with_creep(value, error):
    """An answer whose parameter comes as a list."""
    said = {"value": value, "standard_error": error, "unit": "-"}
    return gap(named("creep", parameters={"magnitudes": said}))


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (None, "gap.json"),
        ({"verdict": "named"}, "expected the key"),
        (gap(named("creep", confidence=1.5)), "confidence: 1.5"),
        (gap(verdict="perhaps"), "'perhaps' is unknown"),
        (gap(after=float("nan")), "after"),
        (gap(), "without an effect"),
        (gap(named("creep"), verdict="no-gap"), "with effects named"),
        (RIGHT | {"truth": 1}, "unknown key 'truth'"),
        (gap(named("a resonance")), "'a resonance'; expected letters a-z"),
        (gap(named("creep=1")), "'creep=1'; expected letters a-z"),
        (gap(named("creep", ties=["drift "])), "'drift '; expected letters a-z"),
        (gap(named("creep"), before=1e200), "a number beyond 1e+100"),
        (gap(named("creep"), after=-(10**400)), "a number beyond 1e+100"),
        (with_creep([0.1, "x"], None), "'magnitudes': value; expected numbers"),
        (with_creep([[0.1]], None), "'magnitudes': value; expected numbers"),
        (with_creep([0.1], [True]), "'magnitudes': standard_error; expected"),
        (with_creep([0.1], [10**400]), "a number beyond 1e+100"),
    ],
)
def test_a_malformed_answer_loses_the_case_with_the_reason(content, reason):
    row = judged(truth(effect()), content)
    assert reason in row.lost
    assert (row.top1, row.in_set, row.exact, row.where_hit) == (False,) * 4
    assert (row.verdict, row.shrink, row.named) == ("", 0.0, "")


def test_no_answer_on_a_case_with_nothing_hidden_is_not_right():
    row = judged(truth(kind="none"), None, status="no answer within 60 s")
    assert row.lost == "no answer within 60 s"
    assert row.false_alarm is True


@pytest.mark.parametrize(
    ("asked", "place", "share"),
    [
        (view(low=60.0, high=80.0), FREQUENCY, 0.9),
        # half of the bin from 60 to 80 Hz, and half of the one below
        (view(low=30.0, high=70.0), FREQUENCY, 0.05 + 0.45),
        (view(low=90.0, high=200.0), FREQUENCY, 0.0),
        (view("branch", "rising", "rising", ""), BRANCH, 0.7),
        (view("branch", "falling", "rising", ""), BRANCH, 1.0),
        (view("branch", "up", "up", ""), BRANCH, 0.0),
        (view("delay", 0.9e-3, 1.1e-3, "s"), DELAY, 1.0),
        (view("delay", 0.6e-3, 0.8e-3, "s"), DELAY, 1.0),
        (view("delay", 3e-3, 4e-3, "s"), DELAY, 0.0),
        (view("slow-time", 1.0, 9.0, "s"), TIME, 0.75),
        (view("amplitude", "a", "b", "A"), AMPLITUDE, 0.0),
    ],
)
def test_what_a_range_holds(asked, place, share):
    assert share_held(asked, place) == pytest.approx(share)


def test_a_magnitude_is_of_both_signs():
    inner = AMPLITUDE | {"edges": [-2.0, -1.0, 1.0, 2.0], "shares": [0.2, 0.5, 0.3]}
    outer = view("amplitude", 1.0, 2.0, "A")
    assert share_held(outer, inner) == pytest.approx(0.3)
    assert share_held(outer | {"axis": "magnitude of the input"}, inner) == (
        pytest.approx(0.5)
    )
    whole = view("amplitude", 0.0, 2.0, "A") | {"axis": "abs(u)"}
    assert share_held(whole, inner) == pytest.approx(1.0)


def test_the_first_view_must_be_of_the_right_kind():
    # the amplitude's range holds all of the power, and tells nothing of a resonance
    assert not where_hit(view("amplitude", -1.0, 1.0, "A"), [effect()])
    assert where_hit(view(), [effect()])
    assert not where_hit(view(low=0.0, high=65.0), [effect()])
    assert not where_hit(None, [effect()])
    row = judged(
        truth(effect()),
        gap(named("resonance"), views=[view("record", "a", "b", ""), view()]),
    )
    assert row.where_hit is False


def value(number, error, unit="Hz"):
    return {"value": number, "standard_error": error, "unit": unit}


def test_parameters_and_their_intervals():
    true = {"frequency_hz": 100.0, "damping_ratio": 0.02, "participation": 0.1}
    said = {
        # 1.5 standard errors off; 3 off; no interval
        "frequency_hz": value(101.5, 1.0),
        "damping_ratio": value(0.026, 0.002),
        "participation": value(0.1, None),
    }
    row = judged(
        truth(effect(parameters=true)), gap(named("resonance", parameters=said))
    )
    assert (row.parameters, row.intervals, row.covered) == (3, 2, 1)
    # relative errors 0.015, 0.3 and 0
    assert row.parameter_error == pytest.approx(0.015)


def test_lists_are_compared_number_by_number():
    true = {"magnitudes": [0.1], "time_constants_s": [2.0]}
    said = {
        "magnitudes": value([0.11], [0.01], "-"),
        "time_constants_s": value([2.0, 3.0], None, "s"),
    }
    about = truth(effect("creep", "one-element", true))
    row = judged(about, gap(named("creep", parameters=said)))
    assert (row.parameters, row.intervals, row.covered) == (1, 1, 1)


@pytest.mark.parametrize(("unit", "compared"), [("um", 1), ("A", 0)])
def test_a_law_of_the_field_has_no_number_of_one_behind_the_loop(unit, compared):
    hidden = effect("saturation", "tanh", {"level": 40.0}) | {"units": {"level": "um"}}
    said = {"level": value(40.0, 1.0, unit)}
    row = judged(truth(hidden), gap(named("saturation", parameters=said)))
    assert row.parameters == compared


def test_another_form_has_no_true_parameters():
    about = truth(effect("saturation", "algebraic", {"level": 40.0, "sharpness": 2.0}))
    said = {"level": value(40.0, 1.0, "um")}
    assert judged(about, gap(named("saturation", parameters=said))).parameters == 0
    rod = truth(
        effect("eddy-diffusion", "rod", {"time_constant_s": 1e-3, "geometry": "rod"})
    )
    for geometry, compared in (("slab", 0), ("rod", 1)):
        said = {
            "time_constant_s": value(1e-3, 1e-4, "s"),
            "geometry": value(geometry, None, "-"),
        }
        row = judged(rod, gap(named("eddy-diffusion", parameters=said)))
        assert row.parameters == compared


def test_rows_come_back_as_they_were(tmp_path):
    rows = [
        judged(truth(effect()), RIGHT),
        judged(truth(kind="none"), None, status='exit status 1: a, "b"'),
        judged(
            truth(effect("dropouts", "only"), kind="unlisted"), gap(verdict="unnamed")
        ),
    ]
    write_rows(tmp_path / "rows.csv", rows)
    read = read_rows([tmp_path / "rows.csv"])
    pd.testing.assert_frame_equal(read, frame(rows))
    write_frame(tmp_path / "again.csv", read)
    assert (tmp_path / "again.csv").read_bytes() == (tmp_path / "rows.csv").read_bytes()
    first = read.iloc[0]
    for name, value in dataclasses.asdict(rows[0]).items():
        assert (value is None and pd.isna(first[name])) or first[name] == value, name


def test_other_columns_are_refused(tmp_path):
    (tmp_path / "rows.csv").write_text("solver,case\na,b\n")
    with pytest.raises(InputError, match="no column 'seed'"):
        read_rows([tmp_path / "rows.csv"])


def test_a_cell_that_is_neither_true_nor_false_is_refused(tmp_path):
    write_rows(tmp_path / "rows.csv", [judged(truth(effect()), RIGHT)])
    text = (tmp_path / "rows.csv").read_text()
    assert ",True," in text
    other = tmp_path / "other.csv"
    other.write_text(text.replace(",True,", ",maybe,", 1))
    with pytest.raises(InputError, match="'maybe' is no truth"):
        read_rows([other])
