"""Shares, intervals and calibration of the contest, against counts by hand."""

import csv
import dataclasses
import json
from statistics import NormalDist

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.challenge.contest import tables
from hystbench.challenge.contest.summary import (
    carried_over,
    figures,
    reach,
    summary,
    write_score,
)
from hystbench.challenge.contest.tables import frame, wilson

from .made import effect, gap, judged, named, truth, view


def row(about, content, case="c", solver="s", **more):
    found = judged(about, content, case=case, solver=solver)
    return dataclasses.replace(found, **more)


def test_wilsons_interval_of_a_textbook():
    # A. Agresti, B. A. Coull, The American Statistician 52 (1998): no success in 10
    found = wilson(0, 10)
    assert (found.share, found.low) == (0.0, 0.0)
    assert found.high == pytest.approx(0.2775, abs=5e-5)


@given(st.integers(1, 2000), st.data())
def test_wilsons_interval_is_where_the_score_test_turns(cases, data):
    hits = data.draw(st.integers(0, cases))
    found = wilson(hits, cases)
    z = NormalDist().inv_cdf(0.975)
    assert 0 <= found.low <= found.share <= found.high <= 1
    for end in (found.low, found.high):
        if 1e-9 < end < 1 - 1e-9:
            # |share - p| = z sqrt(p (1 - p) / n) at both ends
            apart = abs(hits / cases - end)
            assert apart == pytest.approx(
                z * (end * (1 - end) / cases) ** 0.5, rel=1e-6
            )


def test_no_cases_no_share():
    assert wilson(0, 0) == (None, None, None, 0)


RESONANCE = gap(named("resonance", 0.95), views=[view()])
CREEP = gap(named("creep", 0.75), views=[view()])
NOTHING = gap(verdict="no-gap")


ABOUT = {
    "set": "small",
    "scale": 0.5,
    "kept": 2,
    "transfer_set": "transfer",
    "transfer_scale": 0.25,
    "seeds_used_while_mending": {"development": [1, 9], "earlier": [20, 29]},
}


def a_contest():
    """Four singles (3 right), two of nothing (1 right), one pair, one unlisted."""
    single = truth(effect())
    foreign = truth(effect(), family="preisach")
    pair = truth(effect(), effect("creep", "one-element"), kind="pair")
    unlisted = truth(effect("dropouts", "only"), kind="unlisted")
    return [
        row(single, RESONANCE),
        row(single, RESONANCE),
        row(single, CREEP),
        row(foreign, RESONANCE),
        row(truth(kind="none"), NOTHING),
        row(truth(kind="none"), RESONANCE),
        row(pair, gap(named("resonance", 0.95), named("creep", 0.75))),
        row(unlisted, gap(verdict="unnamed")),
    ]


def test_the_summary_by_hand():
    told = summary(frame(a_contest()))
    assert told["cases"] == 8
    assert told["top1"]["20"]["gpi"]["share"] == pytest.approx(2 / 3)
    assert told["top1"]["20"]["foreign"] == told["top1"]["20"]["preisach"]
    assert told["top1"]["20"]["preisach"]["share"] == 1.0
    assert "jiles-atherton" not in told["top1"]["20"]
    assert told["exact_set"]["20"]["gpi"]["cases"] == 3
    assert told["false_alarm"]["share"] == 0.5
    assert told["pairs_both"]["share"] == 1.0
    assert told["triples_all"]["share"] is None
    assert told["unlisted_unnamed"]["share"] == 1.0
    # named: 0.95 right 4 of 5 times, 0.75 right once of two
    squares = 4 * 0.05**2 + 0.95**2 + 0.25**2 + 0.75**2
    assert told["brier"] == pytest.approx(squares / 7)
    assert told["seconds_per_case"] == 1.5
    assert told["where_hit"]["20"]["gpi"]["share"] == 1.0


def test_calibration_by_hand():
    rows = a_contest()
    bins = {item[0]: item for item in tables.reliability(frame(rows))}
    assert bins[0.95][2:4] == (pytest.approx(0.95), pytest.approx(0.8))
    assert bins[0.7][2:4] == (pytest.approx(0.75), pytest.approx(0.5))
    # 5 effects off by 0.15 and 2 off by 0.25
    assert tables.calibration_error(frame(rows)) == pytest.approx(
        (5 * 0.15 + 2 * 0.25) / 7
    )


def test_certainty_has_a_bin():
    rows = [row(truth(effect()), gap(named("resonance", 1.0)))]
    assert [item[:3] for item in tables.reliability(frame(rows))] == [(0.95, 1.0, 1.0)]


def test_what_was_asked_beside_what_was_reached():
    rows = a_contest()
    told = {item.figure: item for item in reach(frame(rows))}
    assert told["top1 GPI 20 dB"].met is False
    assert told["top1 foreign 20 dB"].met is True
    assert told["top1 GPI 10 dB"].met is None
    assert told["false_alarm"].met is False
    assert told["seconds_per_case"].met is False
    # 3 of 4 at home: at least 70 % elsewhere
    away = [row(truth(effect()), RESONANCE)] * 7 + [row(truth(effect()), CREEP)] * 3
    transfer = carried_over(frame(rows), frame(away))
    assert transfer.figure == "transfer top1 20 dB"
    assert (transfer.reached, transfer.asked, transfer.met) == (0.7, ">= 0.700", True)


def test_closed_gaps_and_intervals_by_hand():
    """Three singles and a case of nothing, which has neither gap nor numbers."""
    of_case = [
        {"shrink": 0.2, "parameters": 2, "intervals": 2, "covered": 1},
        {"shrink": 0.9, "parameters": 3, "intervals": 2, "covered": 2},
        {"shrink": 1.0, "parameters": 1, "intervals": 1, "covered": 1},
    ]
    rows = [row(truth(effect()), RESONANCE, **more) for more in of_case]
    rows.append(row(truth(kind="none"), NOTHING, shrink=None))
    told = summary(frame(rows))
    assert told["shrink_median"] == 0.9
    assert (told["coverage"]["share"], told["coverage"]["cases"]) == (0.8, 5)
    assert told["without_interval"] == 1
    asked = {item.figure: item.met for item in reach(frame(rows))}
    assert not asked["shrink_median"]
    assert not asked["coverage of 95 % intervals"]


def test_unlisted_effects_named_with_confidence():
    unlisted = truth(effect("dropouts", "only"), kind="unlisted")
    sure, unsure = (gap(named("creep", size)) for size in (0.81, 0.79))
    told = summary(frame([row(unlisted, sure), row(unlisted, unsure)]))
    assert told["unlisted_confident"]["share"] == 0.5
    assert told["unlisted_unnamed"]["share"] == 0.0


def test_what_else_there_is_to_say_by_hand():
    rows = [
        dataclasses.replace(item, set_size=size, parameter_error=error)
        for item, size, error in zip(
            a_contest(),
            (1, 2, 3, 4, None, None, 9, None),
            (0.1, 0.3, None, 0.2, None, None, None, None),
            strict=True,
        )
    ]
    reached = {each.name: each.of(frame(rows)) for each in figures("further")}
    told = {name: (found.share, found.cases) for name, found in reached.items()}
    assert told["in_set gpi 20 dB"] == (pytest.approx(2 / 3), 3)
    assert told["in_set preisach 20 dB"] == (1.0, 1)
    assert told["in_set jiles-atherton 20 dB"] == (None, 0)
    assert told["pairs_exact"] == (1.0, 1)
    assert told["set_size at 20 dB, mean"] == (2.5, 4)  # the pair's is not counted
    assert told["relative error of parameters, median"] == (0.2, 3)


def test_the_confusion_counts_each_case_once():
    rows = a_contest()
    counts = tables.confusion(frame(rows))
    assert ("single", "resonance", "resonance", "yes", 3) in counts
    assert ("single", "resonance", "creep", "no", 1) in counts
    assert ("none", "none", "no-gap", "yes", 1) in counts
    assert ("unlisted", "dropouts", "unnamed", "yes", 1) in counts
    assert sum(item[-1] for item in counts) == 7


def test_what_was_confused_and_what_would_tell_it_apart():
    found = tables.confused(frame(a_contest()))
    assert found == [("resonance", "creep", 1, 4, tables.NO_EXPERIMENT)]


@pytest.mark.parametrize(
    ("one", "other", "told"),
    [
        ("drive-lag", "sensor-lag", "one amplitude at several rates"),
        ("eddy-diffusion", "input-delay", "a multisine up to half"),
        ("drift", "creep", "the same record again"),
        ("creep", "thermal-drift", "long holds"),
        ("dropouts", "creep", tables.NO_EXPERIMENT),
    ],
)
def test_experiments_go_both_ways(one, other, told):
    assert tables.experiment(one, other).startswith(told)
    assert tables.experiment(other, one) == tables.experiment(one, other)


def test_power_by_ratio():
    weak = truth(effect(), ratio_db=10.0)
    rows = [*a_contest(), row(weak, CREEP), row(weak, RESONANCE)]
    told = {item[:3]: item[3] for item in tables.power(frame(rows))}
    assert told["resonance", "gpi", 10.0] == 0.5
    assert told["all", "all", 20.0] == 0.75


def test_the_score_as_files(tmp_path):
    rows = [*a_contest(), dataclasses.replace(a_contest()[0], solver="other")]
    write_score(frame(rows), frame([]), "s", ABOUT, tmp_path)
    told = json.loads((tmp_path / "summary.json").read_text())
    asked = "cases where_hit top1 in_set exact_set false_alarm pairs_both triples_all"
    asked += " unlisted_unnamed shrink_median brier coverage seconds_per_case transfer"
    assert set(asked.split()) <= set(told)
    assert told["cases"] == 8
    lines = (tmp_path / "rivals.csv").read_text().splitlines()
    assert [line.split(",")[0] for line in lines] == ["solver", "s", "other"]
    # `hystbench docs` parts the columns that a page asks for by commas
    assert '"' not in lines[0]
    reached = (tmp_path / "reach.csv").read_text()
    assert "top1 GPI 20 dB,>= 0.97,0.6667" in reached


def table(path):
    with path.open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def test_rivals_are_held_against_the_solver_on_their_own_cases(tmp_path):
    own = [
        row(truth(effect()), RESONANCE, case="a"),
        row(truth(effect()), CREEP, case="b"),
    ]
    rival = row(truth(effect()), RESONANCE, case="a", solver="rival")
    write_score(frame([*own, rival]), frame([]), "s", ABOUT, tmp_path)
    told = {
        line["solver"]: (line["cases"], line["top1 GPI 20 dB"])
        for line in table(tmp_path / "rivals.csv")
    }
    same = "s, the rivals' cases"
    assert told == {"s": ("2", "0.5"), same: ("1", "1.0"), "rival": ("1", "1.0")}


def test_which_cases_the_score_is_of_and_which_group_was_left_out(tmp_path):
    own = [row(truth(effect(), seed=seed), RESONANCE) for seed in (30, 10, 20)]
    away = [row(truth(effect("creep", "three-elements"), seed=40), CREEP)]
    away.append(row(truth(effect("creep", "fractional"), seed=41), RESONANCE))
    write_score(frame(own), frame(away), "s", ABOUT, tmp_path)
    assert [tuple(line.values()) for line in table(tmp_path / "contest.csv")] == [
        ("small", "0.5", "3", "10", "30"),
        ("transfer", "0.25", "2", "40", "41"),
        ("development", "", "", "1", "9"),
        ("earlier", "", "", "20", "29"),
    ]
    groups = {line["group"]: line for line in table(tmp_path / "kept.csv")}
    assert [n for n, line in groups.items() if line["left out"] == "yes"] == ["2"]
    assert groups["2"]["families"] == "preisach, impedance"
    assert json.loads((tmp_path / "summary.json").read_text())["kept"] == 2
    # the fractional creep belongs to another group
    seen = table(tmp_path / "never-seen.csv")
    told = [(line["name"], line["cases"], line["right"]) for line in seen]
    assert told == [("creep: three-elements", "1", "1.0"), ("all", "1", "1.0")]


def test_what_carries_to_the_transfer_set_and_what_does_not_is_counted(tmp_path):
    single = truth(effect())
    home = [row(single, RESONANCE)] * 19 + [row(single, CREEP)]

    def carried(away):
        write_score(frame(home), frame(away), "s", ABOUT, tmp_path)
        lines = {line["figure"]: line for line in table(tmp_path / "reach.csv")}
        off = lines["transfer: shares more than 5 points off"]
        told = {line["figure"]: line for line in table(tmp_path / "transfer.csv")}
        return told, float(off["reached"]), off["met"]

    # 19 of 20 here, 9 of 10 there: five points
    away = [row(single, RESONANCE, cpu_seconds=9.0)] * 9 + [row(single, CREEP)]
    told, off, met = carried(away)
    assert list(told["top1 GPI 20 dB"].values())[1:] == ["0.95", "0.9", "-0.05", "yes"]
    assert told["seconds_per_case"]["within 5 points"] == ""
    assert "top1 foreign 20 dB" not in told
    assert (off, met) == (0.0, "yes")
    told, off, met = carried([row(single, RESONANCE)] * 8 + [row(single, CREEP)] * 2)
    assert told["top1 GPI 20 dB"]["within 5 points"] == "no"
    assert off >= 1
    assert met == "no"


def test_right_answers_in_plain_words_failures_among_them(tmp_path):
    single, none = truth(effect()), truth(kind="none")
    home = [row(single, RESONANCE)] * 3 + [row(single, CREEP)]
    home += [row(none, RESONANCE)] + [row(none, NOTHING)] * 3
    away = [row(single, RESONANCE), row(single, CREEP)]
    write_score(frame(home), frame(away), "s", ABOUT, tmp_path)
    told = [tuple(line.values()) for line in table(tmp_path / "in-words.csv")]
    assert told == [
        ("one effect 20 dB above the noise, base exact", "75 % of 4", "50 % of 2"),
        ("nothing", "75 % of 4", ""),  # one false alarm of four
    ]


def test_the_shares_of_an_effect_stand_at_each_ratio():
    hard, single = truth(effect(), family="preisach"), truth(effect())
    rows = [row(single, RESONANCE), row(single, CREEP)]
    rows.append(row(hard, RESONANCE, ratio_db=10.0))
    found = {item[:4]: item[4:] for item in tables.by_effect(frame(rows))}
    assert found["resonance", "gpi", 20.0, "top1"] == tuple(wilson(1, 2))
    assert found["resonance", "all", 20.0, "top1"] == tuple(wilson(1, 2))
    assert found["resonance", "preisach", 10.0, "top1"] == tuple(wilson(1, 1))
    assert ("resonance", "preisach", 20.0, "top1") not in found


def test_how_hard_an_effect_is_once_the_base_is_tuned():
    left = (18.0, 2.0, 11.0)
    rows = [row(truth(effect()), RESONANCE, ratio_retuned_db=x) for x in left]
    (found,) = tables.retuned(frame(rows))
    assert found == ("resonance", 20.0, 2.0, 11.0, 18.0, 3)
