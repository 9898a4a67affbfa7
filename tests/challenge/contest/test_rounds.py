"""The scores of what was left out are collected, round by round."""

import csv
import json

import pytest

from tests.conftest import run_hystbench

COLUMNS = [
    "sort",
    "name",
    "cases",
    "right",
    "low",
    "high",
    "confidently_wrong",
    "called",
]


def score(folder, kept, first, right, name="published"):
    """Files of a score: three forms in all, so many of them right."""
    folder.mkdir()
    about = {"set": name, "kept": kept, "seeds": [first, first + 9]}
    (folder / "summary.json").write_text(json.dumps(about))
    with (folder / "never-seen.csv").open("w", newline="") as stream:
        write = csv.writer(stream)
        write.writerow(COLUMNS)
        write.writerow(["form", "creep: rod", 1, 0.0, 0.0, 0.8, 0.0, ""])
        write.writerow(["form", "all", 3, right, 0.1, 0.9, 0.0, "drift 1"])
    return folder


@pytest.fixture
def collect(tmp_path):
    out = tmp_path / "rounds.csv"

    def run(*folders):
        done = run_hystbench(
            "job", "blind-rounds", *map(str, folders), "--to", str(out)
        )
        assert done.returncode == 0, done.stderr
        with out.open(newline="") as stream:
            rows = csv.DictReader(stream)
            names = ("set", "group", "first_seed", "right")
            return [tuple(row[name] for name in names) for row in rows]

    return run


def test_each_round_adds_the_group_that_it_left_out(tmp_path, collect):
    first = score(tmp_path / "a", 1, 100, 0.5)
    second = score(tmp_path / "b", 2, 200, 0.25)
    assert collect(first) == [("published", "1", "100", "0.5")]
    # a later round keeps the earlier one's, whichever comes first
    expected = [("published", "1", "100", "0.5"), ("published", "2", "200", "0.25")]
    assert collect(second) == expected


def test_the_same_cases_are_scored_once(tmp_path, collect):
    collect(score(tmp_path / "a", 1, 100, 0.5))
    again = score(tmp_path / "b", 1, 100, 0.75)
    machines = score(tmp_path / "c", 1, 300, 1.0, "mechanisms")
    assert collect(again, machines) == [
        ("published", "1", "100", "0.5"),
        ("mechanisms", "1", "300", "1.0"),
    ]


def test_a_table_of_other_columns_is_left_alone(tmp_path):
    out = tmp_path / "rounds.csv"
    out.write_text("a,b\n1,2\n")
    folder = score(tmp_path / "a", 1, 100, 0.5)
    done = run_hystbench("job", "blind-rounds", str(folder), "--to", str(out))
    assert done.returncode == 2
    assert "expected the columns set, group" in done.stderr
    assert out.read_text() == "a,b\n1,2\n"
