"""The blind contest through the real workflow: a few cases, solvers good and bad."""

import json
import re
import sys

import pytest

from hystbench.challenge.contest.plan import DEVELOPMENT_SEEDS, RETIRED_SEEDS, plan
from hystbench.challenge.plant.effects import IN_ACTUATOR
from tests.conftest import table

from .conftest import Workflow, small_config

PLACES = ["{dataset}", "{model}", "{out}"]
SOLVER = """
import hashlib, json, os, sys, time
from pathlib import Path

dataset, model, out = map(Path, sys.argv[1:])
number = int(hashlib.sha256(model.read_bytes()).hexdigest(), 16)
"""
ANSWER = """
out.mkdir()
gap = {
    "dataset": "d", "model": "m", "unit": "um", "verdict": "unnamed", "reason": reason,
    "effects": [],
    "where": [], "ranking": [], "next_experiment": None,
    "gap": {
        "before": 1.0, "after": 0.5, "noise_floor": 0.1, "floor_method": "repeats",
        "explained": 0.75,
    },
}
(out / "gap.json").write_text(json.dumps(gap))
"""
#: A third of the cases crash, a third hang, a third are malformed.
BAD = """
if number % 3 == 0:
    raise RuntimeError("a bug")
if number % 3 == 1:
    time.sleep(600)
out.mkdir()
(out / "gap.json").write_text('{"verdict": "named"}')
"""
#: Looks for the truth wherever it can: beside what it was given, where it runs, in the
#: contest's own results. A name in a file is told in the reason.
SPY = """
names = {names!r}
places = [dataset.parent, Path.cwd(), Path({results!r})]
files = [f for place in places for f in place.rglob("*") if f.is_file()]

def text(file):
    try:
        return file.read_text(errors="replace")
    except FileNotFoundError:
        return ""  # another job's, which took its place meanwhile

telling = {{"truth", "ratio_db", "seed"}} | set(names)
held = [(str(file), text(file)) for file in files]
found = [
    f"{{file}}: {{name}}"
    for file, content in held
    for name in telling
    if name in file or name in content
]
reason = json.dumps([len(files), found, sys.argv[1:], str(Path.cwd())])
"""


#: What six of the small set's dozen cases hide: alone, with others, and without a name.
HIDDEN = ["dead-zone", "saturation", "amplitude-dependent-delay"]
COUNT = len(plan("small", only=HIDDEN))
"""Cases of these: the group that is left out goes round, and takes one with it."""


def entered(folder, name, text):
    (folder / f"{name}.py").write_text(text)
    return {
        "command": [sys.executable, "-S", str(folder / f"{name}.py"), *PLACES],
        "time_limit_s": 1.0 if name == "bad" else 30.0,
    }


def contest(folder, solvers, solver):
    config = small_config()
    config["blind"] |= {
        "set": "small",
        "transfer_scale": 0,
        "left_out_scale": 0,
        "chunk": 12,
        "solver": solver,
        "solvers": solvers,
    }
    return config


@pytest.fixture(scope="module")
def held(tmp_path_factory):
    """A contest of a spy, who answers, and a solver that fails in every way."""
    workflow = Workflow(tmp_path_factory.mktemp("blind"))
    folder = tmp_path_factory.mktemp("solvers")
    # a mode may stand in the base model
    names = sorted(set(IN_ACTUATOR) - {"resonance", "hysteresis"})
    results = str(workflow.folder / "results")
    spy = SOLVER + SPY.format(names=names, results=results) + ANSWER
    solvers = {
        "spy": entered(folder, "spy", spy),
        "bad": entered(folder, "bad", SOLVER + BAD),
    }
    config = contest(folder, solvers, "spy")
    config["blind"] |= {"only": HIDDEN, "chunk": 6}
    workflow.configure(config)
    done = workflow.run("blind")
    return workflow, done


def rows_of(workflow, name):
    return table(workflow.folder / "results" / "blind" / f"{name}.csv")


def test_all_jobs_run_and_leave_their_files(held):
    workflow, done = held
    assert COUNT >= 5
    assert (done["blind_make"], done["blind_solve"], done["blind_judge"]) == (1, 2, 1)
    blind = workflow.folder / "results" / "blind"
    summary = json.loads((blind / "summary.json").read_text())
    assert (summary["cases"], summary["lost"]) == (COUNT, 0)
    assert summary["top1"]["20"]["gpi"]["cases"] == 2
    assert summary["seeds_used_while_mending"] == {
        "development and tests": [0, DEVELOPMENT_SEEDS.stop - 1],
        "earlier scores": [1_000_000, RETIRED_SEEDS.stop - 1],
    }
    for name in ("confusion", "effects", "power", "reliability", "where"):
        assert (blind / "figures" / f"blind-{name}.png").stat().st_size > 0
    # data are thrown away when all have solved them
    assert not list(blind.glob("data/*/*"))


def test_the_contest_goes_on_when_a_solver_fails(held):
    workflow, _ = held
    rows = rows_of(workflow, "cases")
    assert len(rows) == 2 * COUNT
    bad = {row["lost"].split(":")[0] for row in rows if row["solver"] == "bad"}
    known = {"exit status 1", "no answer within 1 s", "gap.json"}
    assert bad <= known
    assert len(bad) >= 2
    told = [row["lost"] for row in rows if row["lost"].startswith("exit")]
    assert all("RuntimeError: a bug" in text for text in told)
    assert not any(row["lost"] for row in rows if row["solver"] == "spy")
    rivals = {row["solver"]: row for row in rows_of(workflow, "rivals")}
    assert rivals["bad"]["lost"] == str(COUNT)


def test_the_truth_is_what_was_planned(held):
    workflow, _ = held
    planned = {
        entry.name: " ".join(entry.spec.effects) for entry in plan("small", only=HIDDEN)
    }
    rows = [row for row in rows_of(workflow, "cases") if row["solver"] == "spy"]
    assert {row["case"]: row["truth"] for row in rows} == planned


def test_a_solver_that_looks_for_the_truth_finds_none(held):
    workflow, _ = held
    answers = workflow.folder / "results" / "blind" / "answers" / "small" / "spy"
    for file in sorted(answers.glob("*.json")):
        for case in json.loads(file.read_text())["cases"].values():
            files, found, words, place = json.loads(case["gap"]["reason"])
            assert files > 12
            assert not found, found
            for text in (*words, place):
                assert str(workflow.folder) not in text
                assert "case-" not in text


def test_a_solver_job_has_the_data_as_its_only_input(held):
    workflow, _ = held
    detailed = workflow.snakemake(
        "results/blind/answers/small/spy/0000.json", "--forceall", "--detailed-summary"
    )
    lines = detailed.stdout.splitlines()
    head = lines[0].split("\t")
    for line in lines[1:]:
        about = dict(zip(head, line.split("\t"), strict=False))
        if "answers" in about["output_file"]:
            inputs = about["input-file(s)"].split(",")
            data = [name for name in inputs if not name.endswith((".py", ".so"))]
            assert data == ["results/blind/data/small/0000"]
            break
    else:
        raise AssertionError(detailed.stdout + detailed.stderr)


def test_afterwards_there_is_nothing_to_do(held):
    workflow, _ = held
    assert workflow.would_run("blind") == {}


def test_a_solver_that_did_not_enter_is_told_in_one_line(held):
    workflow, _ = held
    told = workflow.refused("blind", "--config", "blind={solver: spi}")
    assert "blind: solver: 'spi'; did you mean 'spy'?" in told


def test_the_gaps_own_solver_enters_the_contest(tmp_path):
    """With a share, as a solver that takes its time may enter: of nine, three cases.

    What it answers is for the tests of the gap, and of its command for this line.
    """
    workflow = Workflow(tmp_path / "contest")
    workflow.folder.mkdir()
    own = small_config()["blind"]["solvers"]["gap"] | {"share": 0.3}
    plain = entered(tmp_path, "plain", SOLVER + "reason = 'none is tried'\n" + ANSWER)
    config = contest(tmp_path, {"plain": plain, "gap": own}, "plain")
    config["blind"] |= {"scale": 0.25, "chunk": 3}
    workflow.configure(config)
    planned = workflow.would_run("blind")
    assert planned["blind_solve"] == 4  # three chunks, and the first one twice


def test_machines_have_a_transfer_set_of_their_own(tmp_path):
    workflow = Workflow(tmp_path / "contest")
    workflow.folder.mkdir()
    plain = entered(tmp_path, "plain", SOLVER + "reason = 'none is tried'\n" + ANSWER)
    config = contest(tmp_path, {"plain": plain}, "plain")
    config["blind"] |= {"set": "mechanisms-development", "transfer_scale": 0.01}
    workflow.configure(config)
    printed = workflow.snakemake("blind", "--dry-run", "--printshellcmds").stdout
    assert "results/blind-mechanisms/judged/mechanisms-transfer/0000.csv" in printed
    assert "judged/transfer" not in printed


def test_a_solver_may_not_name_what_is_left_out(tmp_path):
    workflow = Workflow(tmp_path / "contest")
    workflow.folder.mkdir()
    plain = entered(tmp_path, "plain", SOLVER + "reason = 'none is tried'\n" + ANSWER)
    words = {"left_out": ["--without", "{effect}"]}
    config = contest(tmp_path, {"plain": plain | words}, "plain")
    config["blind"]["left_out_scale"] = 0.02
    workflow.configure(config)
    printed = workflow.snakemake("blind", "--dry-run", "--printshellcmds").stdout
    kept = re.findall(r"data/left-out-([a-z-]+)/0000 .*--without\W+([a-z-]+)", printed)
    hidden = {entry.spec.effects[0] for entry in plan("left-out", 0.02)}
    assert {effect for effect, _ in kept} == hidden
    assert all(effect == word for effect, word in kept)
    assert "left-out.csv" in printed


def test_a_solver_that_names_what_it_likes_has_no_score_of_what_is_left_out(tmp_path):
    workflow = Workflow(tmp_path / "contest")
    workflow.folder.mkdir()
    plain = entered(tmp_path, "plain", SOLVER + "reason = 'none is tried'\n" + ANSWER)
    config = contest(tmp_path, {"plain": plain}, "plain")
    config["blind"]["left_out_scale"] = 1.0
    workflow.configure(config)
    told = workflow.refused("blind")
    assert "blind: solvers: plain: left_out: missing" in told
