"""The choice: its rule, its table, and that git has it as it is."""

import csv
import subprocess
from dataclasses import replace

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from hystbench.calibration.choice import (
    RULE,
    check_committed,
    choose,
    write_choice,
    write_structures,
)
from hystbench.calibration.structures import STRUCTURES, find_structure
from hystbench.calibration.twin import UNKNOWNS, make_twin
from hystbench.errors import InputError
from hystbench.published import FILTERS
from tests.conftest import ROOT


def tried(**scores):
    ratios = dict.fromkeys(FILTERS, 0.5)  # beyond a factor of 2
    one = {"signal": "sine-010hz", "log10_ratio": ratios, "rms_error": -0.02}
    same = {"cost": 1, "constraints_met": True, "left_out": [one]}
    return [
        {"name": name, "score": score, "values": values(name), **same}
        for name, score in scores.items()
    ]


def values(name):
    return {item.name: item.low for item in find_structure(name).unknowns}


@given(
    st.dictionaries(
        st.sampled_from([item.name for item in STRUCTURES]),
        st.floats(0, 1e3),
        min_size=1,
    )
)
def test_the_rule_takes_the_least_score_on_whole_records(scores):
    whole = {k: v for k, v in scores.items() if find_structure(k).whole_record}
    if whole:
        assert whole[choose(tried(**scores))] == min(whole.values())
    else:
        with pytest.raises(InputError, match="none is scored on whole records"):
            choose(tried(**scores))


def test_the_committed_choice_has_the_rule_and_a_structure():
    kept = yaml.safe_load((ROOT / "src/hystbench/plants/choice.yaml").read_text())
    assert kept["rule"] == RULE
    chosen = find_structure(kept["chosen"]["name"])
    assert chosen.whole_record
    scores = {
        name: each["left_out_score"]
        for name, each in kept["tried"].items()
        if find_structure(name).whole_record
    }
    assert scores[chosen.name] == min(scores.values())
    assert kept["chosen"] == {"name": chosen.name, **kept["tried"][chosen.name]}


def test_what_is_calibrated_is_what_was_chosen():
    kept = yaml.safe_load((ROOT / "src/hystbench/plants/choice.yaml").read_text())
    chosen = find_structure(kept["chosen"]["name"])
    free = {item.name: item for item in UNKNOWNS}
    assert set(free) == {item.name for item in chosen.unknowns}
    values = {name: item.start for name, item in free.items()}
    assert chosen.make(values).chain == make_twin(values).chain
    for item in chosen.more:
        assert free[item.name] == item
    # Every reading of the chosen structure beside its twin is that of the settings.
    plain = replace(find_structure("base"), name=chosen.name, meaning=chosen.meaning)
    assert replace(chosen, more=()) == plain


def test_the_table_has_the_least_score_first(tmp_path):
    found = tried(base=3.0, creep=2.0, window=1.0)
    write_structures(tmp_path / "tried.csv", found)
    with (tmp_path / "tried.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [row["structure"] for row in rows] == ["window", "creep", "base"]
    assert [row["chosen_by_rule"] for row in rows] == ["", "yes", ""]
    assert [row["whole_record"] for row in rows] == ["no", "yes", "yes"]
    assert float(rows[0]["left_out_worst_factor"]) == pytest.approx(10**0.5, abs=0.01)
    assert float(rows[0]["left_out_within_factor_2"]) == 0
    assert float(rows[0]["left_out_rms_percent"]) == 2
    assert [row["free_beside"] for row in rows] == [
        "",
        "creep 0.03 s = 0; creep 0.3 s = 0; creep 3.0 s = 0",
        "",
    ]
    write_choice(tmp_path / "choice.yaml", found)
    kept = yaml.safe_load((tmp_path / "choice.yaml").read_text())
    assert kept["chosen"] == {
        "name": "creep",
        "in_sample_cost": 1.0,
        "left_out_score": 2.0,
    }
    assert list(kept["tried"]) == ["window", "creep", "base"]


@pytest.fixture
def checkout(tmp_path):
    def git(*words):
        subprocess.run(
            ["git", "-c", "user.name=n", "-c", "user.email=e", *words],
            cwd=tmp_path,
            check=True,
            capture_output=True,
        )

    git("init")
    (tmp_path / "choice.yaml").write_text("chosen: {name: base}\n")
    return tmp_path / "choice.yaml", git


def test_a_committed_choice_passes_until_it_is_edited(checkout):
    choice, git = checkout
    told = []
    with pytest.raises(InputError, match="not committed as it is"):
        check_committed(choice, told.append)
    git("add", "choice.yaml")
    with pytest.raises(InputError, match="not committed as it is"):
        check_committed(choice, told.append)
    git("commit", "-m", "choice")
    check_committed(choice, told.append)
    choice.write_text("chosen: {name: creep}\n")
    with pytest.raises(InputError, match="not committed as it is"):
        check_committed(choice, told.append)
    assert not told


def test_an_ignored_choice_is_not_committed(checkout):
    choice, git = checkout
    (choice.parent / ".gitignore").write_text("choice.yaml\n")
    git("add", ".gitignore")
    git("commit", "-m", "ignore")
    with pytest.raises(InputError, match="not committed as it is"):
        check_committed(choice, tell=pytest.fail)


def test_without_a_checkout_or_git_that_is_told(tmp_path, monkeypatch):
    choice = tmp_path / "choice.yaml"
    choice.write_text("chosen: {name: base}\n")
    told = []
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(tmp_path.parent))
    check_committed(choice, told.append)
    monkeypatch.setenv("PATH", str(tmp_path))
    check_committed(choice, told.append)
    assert "no git checkout" in told[0]
    assert "no git here" in told[1]
