"""Solvers that answer, crash, hang and babble; and where they run."""

import json
import sys
import time

import pytest

from hystbench.entrants.answers import Solver, answer, answer_all
from hystbench.errors import InputError
from hystbench.files import read_json
from hystbench.written import ENTRIES

PLACES = ["{dataset}", "{model}", "{out}"]


@pytest.fixture
def script(tmp_path):
    """Make a solver out of a few lines; dataset, model and out are at hand."""

    def make(lines, limit=20.0):
        file = tmp_path / "solver.py"
        file.write_text(
            "import json, os, sys, time\nfrom pathlib import Path\n"
            f"dataset, model, out = map(Path, sys.argv[1:])\n{lines}\n"
        )
        return Solver("mine", (sys.executable, "-S", str(file), *PLACES), limit)

    return make


@pytest.fixture
def case(tmp_path):
    folder = tmp_path / "contest" / "case-1"
    (folder / "dataset").mkdir(parents=True)
    (folder / "dataset" / "dataset.yaml").write_text("name: x\n")
    (folder / "model.yaml").write_text("name: m\n")
    return folder


GOOD = "out.mkdir()\n(out / 'gap.json').write_text(json.dumps({'verdict': 'no-gap'}))"


def test_an_answer(script, case):
    told = answer(script(GOOD), case)
    assert (told["status"], told["gap"]) == ("answered", {"verdict": "no-gap"})
    assert told["cpu_seconds"] > 0
    assert told["seconds"] > 0


def test_without_a_model_file_the_solver_is_told_linear(script, case):
    (case / "model.yaml").unlink()
    lines = "assert str(model) == 'linear', model\n" + GOOD
    assert answer(script(lines), case)["status"] == "answered"


@pytest.mark.parametrize(
    ("lines", "status"),
    [
        ("raise ValueError('not today')", "exit status 1: ValueError: not today"),
        ("sys.exit(3)", "exit status 3: nothing printed"),
        ("os.abort()", "exit status -6"),
        ("pass", "no gap.json"),
        ("out.mkdir(); (out / 'gap.json').write_text('{')", "gap.json: not JSON"),
        ("out.mkdir(); (out / 'gap.json').write_bytes(b'\\xff')", "gap.json: not JSON"),
        (
            "out.mkdir(); (out / 'gap.json').write_text('{\"a\": NaN}')",
            "gap.json: not JSON (NaN is no number)",
        ),
        (
            "out.mkdir(); (out / 'gap.json').write_text('{\"a\": 1e999}')",
            "gap.json: not JSON (Out of range float values",
        ),
        (
            "out.mkdir(); (out / 'gap.json').write_text('[\"\\\\ud800\"]')",
            "gap.json: not JSON ('utf-8' codec can't encode",
        ),
        (
            "out.mkdir(); (out / 'gap.json').write_text('['*100000)",
            "gap.json: not JSON",
        ),
    ],
)
def test_no_answer_has_a_reason(script, case, lines, status):
    told = answer(script(lines), case)
    assert told["status"].startswith(status)
    assert told["gap"] is None


def test_a_command_that_is_not_there(case):
    told = answer(Solver("x", ("no-such-solver", *PLACES), 5.0), case)
    assert told["status"].startswith("exit status 127")


def test_a_solver_that_hangs_is_ended_with_all_that_it_began(script, case, tmp_path):
    alive = tmp_path / "alive"
    told = answer(
        script(
            "if os.fork() == 0:\n"
            "    while True:\n"
            f"        Path({str(alive)!r}).write_text(str(time.monotonic()))\n"
            "        time.sleep(0.01)\n"
            "time.sleep(600)",
            limit=0.5,
        ),
        case,
    )
    assert told["status"] == "no answer within 0.5 s"
    assert alive.exists()
    time.sleep(0.1)
    last = alive.read_text()
    time.sleep(0.1)
    assert alive.read_text() == last


def test_a_solver_sees_a_copy_and_not_the_contest(script, case, tmp_path, monkeypatch):
    monkeypatch.setenv("PWD", str(tmp_path))
    seen = tmp_path / "seen.json"
    solver = script(
        f"Path({str(seen)!r}).write_text(json.dumps([str(Path.cwd()), sys.argv[1:],"
        " dict(os.environ), sorted(p.name for p in dataset.parent.rglob('*'))]))\n"
        "(dataset / 'dataset.yaml').write_text('spoilt')\n" + GOOD
    )
    answer(solver, case)
    folder, words, environment, files = json.loads(seen.read_text())
    for text in (folder, *words):
        assert str(tmp_path) not in text
        assert "case-1" not in text
    assert {"PWD", "OLDPWD"}.isdisjoint(environment)
    assert files == ["dataset", "dataset.yaml", "model.yaml"]
    assert (case / "dataset" / "dataset.yaml").read_text() == "name: x\n"


def test_a_command_without_a_place_is_refused():
    with pytest.raises(
        InputError, match=r"solvers: x: 'a \{model\}'; expected \{datas"
    ):
        Solver("x", ("a", "{model}"), 1.0)


def test_own_commands_run_in_a_fork_and_say_what_is_wrong(case):
    told = answer(Solver("own", ("hystbench", "rival", "nave", *_own()), 30.0), case)
    assert told["status"].startswith("exit status 2: hystbench: rival: no 'nave'")
    told = answer(Solver("own", ("hystbench", "gpa", *_own()), 30.0), case)
    assert "no command 'gpa'" in told["status"]


def _own():
    return "{dataset}", "--model", "{model}", "--out", "{out}"


def test_what_was_answered_is_kept_when_interrupted(script, case, tmp_path):
    other = case.with_name("case-2")
    (other / "dataset").mkdir(parents=True)
    (other / "model.yaml").write_text("name: other\n")
    count = tmp_path / "count"
    lines = f"with open({str(count)!r}, 'a') as s: s.write('x')\n"
    out = tmp_path / "answers.json"
    stopped = script(lines + GOOD)
    answers = iter([answer(stopped, case)])
    assert next(answers)["status"] == "answered"

    calls = []

    def stop(*given):
        calls.append(given)
        if len(calls) == 2:
            raise KeyboardInterrupt
        return answer(*given)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("hystbench.entrants.answers.answer", stop)
        with pytest.raises(KeyboardInterrupt):
            answer_all(stopped, case.parent, out)
    assert not out.exists()
    before = count.read_text()
    answer_all(stopped, case.parent, out)
    # only the second case was run again
    assert len(count.read_text()) == len(before) + 1
    told = read_json(out)
    assert list(told["cases"]) == ["case-1", "case-2"]
    assert not list(tmp_path.glob("*.unfinished"))
    # an edited case is another case
    (case / "model.yaml").write_text("name: edited\n")
    answer_all(stopped, case.parent, out)
    assert len(count.read_text()) == len(before) + 3


def test_files_are_kept_if_asked(script, case, tmp_path):
    solver = script(GOOD + "\n(out / 'report.html').write_text('page')")
    answer_all(solver, case.parent, tmp_path / "a.json", ["report.html", "none.txt"])
    assert (tmp_path / "a" / "case-1" / "report.html").read_text() == "page"
    kept = {file.name for file in (tmp_path / "a" / "case-1").iterdir()}
    assert kept - {ENTRIES} == {"report.html"}
