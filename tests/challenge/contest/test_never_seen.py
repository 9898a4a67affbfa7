"""What only the transfer set holds, or a solver may not name, is summed up apart."""

import pytest

from hystbench.challenge.contest.never_seen import left_out, never_seen
from hystbench.challenge.contest.tables import frame

from .made import effect, gap, judged, named, truth


def solved(hidden, form, *names, kind="single", family="gpi", sure=0.9, verdict=None):
    about = truth(effect(hidden, form), kind=kind, family=family)
    said = verdict or ("named" if names else "unnamed")
    return judged(about, gap(*(named(name, sure) for name in names), verdict=said))


CASES = [
    solved("creep", "fractional", "creep"),
    solved("creep", "fractional", "thermal-drift"),
    solved("creep", "fractional", "creep", "drift", sure=0.6),
    solved("creep", "one-element", "drift"),
    solved("creep", "one-element", "creep", "hysteresis-shape", family="duhem"),
    solved("stick-slip", "only", kind="unlisted"),
    solved("stick-slip", "only", "backlash", kind="unlisted", family="duhem"),
]


def test_a_form_a_family_and_an_unlisted_effect_have_a_row_each():
    rows = {row[:2]: row[2:] for row in never_seen(frame(CASES), group=1)}
    assert list(rows) == [
        ("form", "creep: fractional"),
        ("form", "all"),
        ("family", "duhem"),
        ("family", "all"),
        ("unlisted", "stick-slip"),
        ("unlisted", "all"),
    ]
    cases, right, _, _, sure, called = rows["form", "creep: fractional"]
    assert (cases, right, sure) == (3, pytest.approx(1 / 3), pytest.approx(1 / 3))
    assert called == "thermal-drift 1, drift 1"
    # the shape is no name there, and an unlisted case is no case of the family
    assert rows["family", "duhem"][:2] == (1, 1.0)
    assert rows["unlisted", "stick-slip"][:2] == (2, 0.5)


def test_a_lost_case_is_no_right_answer():
    about = truth(effect("stick-slip", "only"), kind="unlisted")
    missed = judged(about, None, status="exit status 2")
    ((*_, cases, right, _, _, _, _), _) = never_seen(frame([missed, CASES[5]]), group=1)
    assert (cases, right) == (2, 0.5)


def test_there_may_be_no_transfer_set():
    assert list(never_seen(frame([]))) == []


def test_a_name_in_its_place_counts_against_the_solver():
    table = left_out(
        frame(
            [
                solved("creep", "mode"),
                solved("creep", "mode", "drift"),
                solved("creep", "mode", "drift", sure=0.7),
                solved("creep", "mode", "drift", verdict="unnamed"),
                solved("backlash", "mode", "friction", "creep"),
            ]
        )
    ).set_index("left_out")
    assert list(table.index) == ["backlash", "creep", "all"]
    assert table.loc["creep", ["cases", "no_name", "confident"]].tolist() == [
        4,
        0.5,
        0.25,
    ]
    assert table.loc["creep", "called"] == "drift 2"
    assert table.loc["backlash", "called"] == "friction 1, creep 1"
    assert table.loc["all", "no_name"] == pytest.approx(2 / 5)


def test_the_shape_of_a_foreign_hysteresis_is_no_name_there():
    foreign = solved("creep", "mode", "hysteresis-shape", family="preisach")
    own = solved("creep", "mode", "hysteresis-shape", family="gpi")
    assert left_out(frame([foreign])).iloc[-1]["no_name"] == 1.0
    assert left_out(frame([own])).iloc[-1]["no_name"] == 0.0
