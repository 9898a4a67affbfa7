"""Effects that a solver may not name are summed up by what it names instead."""

import pytest

from hystbench.challenge.contest.never_seen import left_out
from hystbench.challenge.contest.score import judge
from hystbench.challenge.contest.tables import frame
from hystbench.gap.schema import SCHEMA

from .made import effect, gap, named, truth


def judged(hidden, *names, sure=0.9, verdict="named", family="gpi"):
    answer = {
        "status": "answered",
        "gap": gap(*(named(name, sure) for name in names), verdict=verdict),
        "seconds": 1.0,
        "cpu_seconds": 1.0,
    }
    about = truth(effect(hidden), family=family)
    return judge("mine", "case", about, answer, SCHEMA, lambda members: members)


def test_a_name_in_its_place_counts_against_the_solver():
    table = left_out(
        frame(
            [
                judged("creep", verdict="unnamed"),
                judged("creep", "drift"),
                judged("creep", "drift", sure=0.7),
                judged("creep", "drift", verdict="unnamed"),
                judged("backlash", "friction", "creep"),
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
    foreign = judged("creep", "hysteresis-shape", family="preisach")
    own = judged("creep", "hysteresis-shape", family="gpi")
    assert left_out(frame([foreign])).iloc[-1]["no_name"] == 1.0
    assert left_out(frame([own])).iloc[-1]["no_name"] == 0.0
