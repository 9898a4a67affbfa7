"""Cases of another plant are scored by their own truth."""

import json

import pytest
import yaml

from hystbench.challenge.contest.elsewhere import score, told
from tests.conftest import run_hystbench


def case(folder, kind, hidden, named=None, family="gpi", sure=0.9):
    """Write a case; without an answer where ``named`` is None."""
    folder.mkdir()
    effects = [{"name": name, "parameters": {}} for name in hidden]
    truth = {"kind": kind, "family": family, "effects": effects}
    truth["gnr_asked_db"] = None if kind == "none" else 20.0
    (folder / "truth.yaml").write_text(yaml.safe_dump(truth))
    if named is not None:
        answer = [{"name": name, "confidence": sure} for name in named]
        verdict = "named" if named else "unnamed"
        (folder / "result").mkdir()
        content = {"verdict": verdict, "effects": answer}
        (folder / "result" / "gap.json").write_text(json.dumps(content))
    return folder


@pytest.mark.parametrize(
    ("kind", "hidden", "named", "right", "exact"),
    [
        ("single", ["creep"], ["creep"], True, True),
        ("single", ["creep"], ["creep", "drift"], True, False),
        ("single", ["creep"], ["drift", "creep"], False, False),
        ("single", ["offset"], ["calibration-error"], True, True),
        ("single", ["creep"], [], False, False),
        ("single", ["creep"], None, False, False),
        ("pair", ["creep", "drift"], ["drift", "creep"], True, True),
        ("pair", ["creep", "drift"], ["drift"], False, False),
        ("none", [], [], True, True),
        ("none", [], ["creep"], False, False),
        ("none", [], None, False, False),
        ("unlisted", ["unlisted"], [], True, True),
        ("unlisted", ["unlisted"], ["drift"], False, False),
    ],
)
def test_a_case_is_judged_by_what_is_hidden(
    tmp_path, kind, hidden, named, right, exact
):
    row = told(case(tmp_path / "case", kind, hidden, named))
    assert (row["right"], row["exact"]) == (right, exact)


def test_a_wrong_loop_beside_a_foreign_base_is_neither_required_nor_wrong(tmp_path):
    names = ["hysteresis-shape", "creep"]
    row = told(case(tmp_path / "foreign", "single", ["creep"], names, "preisach"))
    assert row["right"]
    assert row["exact"]
    row = told(case(tmp_path / "exact", "single", ["creep"], names))
    assert not row["right"]
    assert row["confidently_wrong"]


def test_the_job_writes_a_row_a_group(tmp_path):
    cases = [
        case(tmp_path / "a", "single", ["creep"], ["creep"]),
        case(tmp_path / "b", "single", ["creep"], ["drift"]),
        case(tmp_path / "c", "unlisted", ["unlisted"], ["drift"], sure=0.7),
        case(tmp_path / "d", "none", [], []),
    ]
    out = tmp_path / "score.csv"
    run_hystbench("job", "blind-elsewhere", *map(str, cases), "--out", str(out))
    none, first, second = score(cases).to_dict("records")
    assert (first["cases"], first["right"], first["confidently_wrong"]) == (2, 0.5, 0.5)
    assert (none["kind"], none["cases"], none["right"]) == ("none", 1, 1.0)
    assert (second["kind"], second["confidently_wrong"]) == ("unlisted", 0.0)
    assert out.read_text().splitlines()[0].startswith("kind,base,ratio_db,cases,right")
