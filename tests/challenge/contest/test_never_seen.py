"""What only the transfer set holds is summed up apart."""

import pytest

from hystbench.challenge.contest.never_seen import never_seen
from hystbench.challenge.contest.score import judge
from hystbench.challenge.contest.tables import frame
from hystbench.gap.schema import SCHEMA

from .made import effect, gap, named, truth


def judged(hidden, form, *names, kind="single", family="gpi", sure=0.9):
    about = truth(effect(hidden, form), kind=kind, family=family)
    content = gap(*(named(name, sure) for name in names))
    if not names:
        content = gap(verdict="unnamed")
    answer = {"status": "answered", "gap": content, "seconds": 1.0, "cpu_seconds": 1.0}
    return judge("mine", "case", about, answer, SCHEMA, lambda members: members)


CASES = [
    judged("creep", "fractional", "creep"),
    judged("creep", "fractional", "thermal-drift"),
    judged("creep", "fractional", "creep", "drift", sure=0.6),
    judged("creep", "one-element", "drift"),
    judged("creep", "one-element", "creep", "hysteresis-shape", family="duhem"),
    judged("stick-slip", "only", kind="unlisted"),
    judged("stick-slip", "only", "backlash", kind="unlisted", family="duhem"),
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
    lost = {"status": "exit status 2", "gap": None, "seconds": 1.0, "cpu_seconds": 1.0}
    about = truth(effect("stick-slip", "only"), kind="unlisted")
    missed = judge("mine", "case", about, lost, SCHEMA, lambda members: members)
    ((*_, cases, right, _, _, _, _), _) = never_seen(frame([missed, CASES[5]]), group=1)
    assert (cases, right) == (2, 0.5)


def test_there_may_be_no_transfer_set():
    assert list(never_seen(frame([]))) == []
