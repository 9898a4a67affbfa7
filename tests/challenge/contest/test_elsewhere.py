"""Cases of another plant are judged as the contest's own."""

import json

import pandas as pd
import pytest
import yaml

from hystbench.challenge.contest.score import write_rows
from hystbench.challenge.contest.tables import frame
from hystbench.commands.jobs.blind_elsewhere import beside, told
from tests.challenge.contest.made import gap, named
from tests.conftest import run_hystbench


def case(folder, kind, hidden, names=None, family="gpi", sure=0.9, **answer):
    """Write a case; without an answer where ``names`` is None."""
    folder.mkdir()
    truth = {
        "seed": 1,
        "kind": kind,
        "family": family,
        "effects": [{"name": name, "parameters": {}} for name in hidden],
        "gnr_asked_db": None if kind == "none" else 20.0,
        "noise_rms": 3.0,
        "model_error_rms_holdout": 4.0,
        "gap_rms_holdout": 12.0,
    }
    (folder / "truth.yaml").write_text(yaml.safe_dump(truth))
    if names is not None:
        effects = [named(name, sure) for name in names]
        verdict = answer.pop("verdict", "named" if names else "unnamed")
        content = gap(*effects, verdict=verdict, **answer)
        (folder / "result").mkdir()
        (folder / "result" / "gap.json").write_text(json.dumps(content))
    return folder


@pytest.mark.parametrize(
    ("hidden", "names", "first", "exact"),
    [
        (["creep"], ["creep"], True, True),
        (["creep"], ["creep", "drift"], True, False),
        (["creep"], ["drift", "creep"], False, False),
        (["offset"], ["calibration-error"], True, True),
        (["creep"], [], False, False),
        (["creep"], None, False, False),
    ],
)
def test_a_single_effect_is_judged_by_what_is_hidden(
    tmp_path, hidden, names, first, exact
):
    row = told(case(tmp_path / "case", "single", hidden, names))
    assert (row.top1, row.exact) == (first, exact)


@pytest.mark.parametrize(
    ("family", "ours"),
    [("ja", "jiles-atherton"), ("linear+gpi-loop", "gpi"), ("preisach", "preisach")],
)
def test_a_wrong_loop_is_wrong_beside_an_exact_base_alone(tmp_path, family, ours):
    names = ["hysteresis-shape", "creep"]
    row = told(case(tmp_path / "case", "single", ["creep"], names, family))
    assert row.family == ours
    assert row.top1 == (ours != "gpi")


def test_a_gap_is_closed_above_the_noise_and_the_error_of_the_base(tmp_path):
    # 13^2 = 3^2 + 4^2 + 12^2, and 5^2 = 3^2 + 4^2: all that could go has gone.
    row = told(case(tmp_path / "case", "single", ["creep"], ["creep"]))
    assert row.shrink == pytest.approx(1.0)


def one(tmp_path, elsewhere):
    """The rows of the table, by figure."""
    table = beside(frame([]), frame(map(told, elsewhere)))
    return table.set_index("figure").to_dict("index")


def test_both_plants_stand_side_by_side(tmp_path):
    cases = [
        case(tmp_path / "a", "single", ["creep"], ["creep"]),
        case(tmp_path / "b", "single", ["creep"], ["drift"]),
        case(tmp_path / "c", "unlisted", ["unlisted"], ["drift"], sure=0.7),
        case(tmp_path / "d", "none", [], [], verdict="no-gap"),
        case(tmp_path / "e", "none", [], []),
        case(tmp_path / "f", "pair", ["creep", "drift"], ["drift", "creep"], "ja"),
    ]
    own, out = tmp_path / "own.csv", tmp_path / "score.csv"
    write_rows(own, [told(cases[0])])
    words = ["job", "blind-elsewhere", *map(str, cases), "--own", str(own)]
    run_hystbench(*words, "--out", str(out))
    table = pd.read_csv(out).set_index("figure").to_dict("index")
    single = table["single, exact base, 20 dB"]
    assert (single["own"], single["own_cases"]) == (1.0, 1)
    assert (single["elsewhere"], single["elsewhere_cases"]) == (0.5, 2)
    assert single["low"] < 0.5 < single["high"]
    assert table["nothing hidden: no name"]["elsewhere"] == 1.0
    assert table["unlisted: no name"]["elsewhere"] == 0.0
    assert table["unlisted: named with more than 0.8"]["elsewhere"] == 0.0
    assert table["pair: nothing beside"]["elsewhere"] == 1.0
    wrongly = table["wrong name with more than 0.8"]
    assert wrongly["elsewhere"] == pytest.approx(1 / 6, abs=1e-4)
    assert table["gap closed, median, foreign base"]["elsewhere_cases"] == 1


def test_stated_confidence_is_held_against_what_is_hidden(tmp_path):
    cases = [
        case(tmp_path / str(k), "single", ["creep"], [name], sure=0.75)
        for k, name in enumerate(["creep", "creep", "creep", "drift"])
    ]
    assert one(tmp_path, cases)["stated confidence off by"]["elsewhere"] == 0.0
    assert one(tmp_path, cases[3:])["stated confidence off by"]["elsewhere"] == 0.75
