"""Wherever a result is written, inputs and files of somebody else stay as they are."""

from __future__ import annotations

import os
import shutil
import tempfile
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click
import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import example, given
from hypothesis import strategies as st

from hystbench import options
from hystbench.cli import COMMANDS
from hystbench.commands.gap import gap
from hystbench.commands.load import load
from hystbench.commands.simulate import simulate
from hystbench.errors import InputError
from hystbench.gap import run as run_module
from hystbench.group import group
from tests.conftest import csv_text, run_hystbench

MODEL = """name: base
input: {name: current, unit: A}
output: {name: displacement, unit: um}
chain: [{gain: {value: 10.0}}]
"""
SAMPLES = 200


def table(size: float) -> str:
    time = np.arange(SAMPLES) * 1e-3
    u = size * np.sin(2 * np.pi * 20 * time)
    return csv_text(time, u, 9.0 * u + 0.1 * np.cos(2 * np.pi * 3 * time))


@dataclass(frozen=True)
class Layout:
    """Where inputs lie, where the result goes, and what else is there.

    ``listed`` are inputs that hystbench wrote itself, as those of ``hystbench hide``.
    """

    hold_out: str = "holdout/c.csv"
    model: str = "data/model.yaml"
    out: str = "data"
    experiment: str | None = None
    strangers: tuple[str, ...] = ()
    link: tuple[str, str] | None = None
    hard_link: tuple[str, str] | None = None
    listed: bool = False


PLACES = (
    "gap.json",
    "GAP.JSON",
    "model.yaml",
    "curves.json",
    "report.html",
    "holdout",
    "holdout/c.csv",
    "holdout/C.csv",
    "holdout/notes.csv",
    "notes.txt",
    ".hystbench",
    ".hystbench/gap.json.sha256",
)
HOLD_OUT = ("holdout/c.csv", "HoldOut/c.csv", "c.csv", "deep/holdout/c.csv")
MODELS = ("data/model.yaml", "model.yaml", "out/model.yaml", "data/curves.json.yaml")
OUTS = (
    "data",
    "data/holdout",
    "data/out",
    "data/deep",
    "Data",
    ".",
    "out",
    "out/../data",
    "alias",
    "new/deep/er",
)
INPUTS = ("data/a.csv", "data/dataset.yaml", "model.yaml", "data/model.yaml")
layouts = st.builds(
    Layout,
    hold_out=st.sampled_from(HOLD_OUT),
    model=st.sampled_from(MODELS),
    out=st.sampled_from(OUTS),
    experiment=st.none()
    | st.sampled_from((*INPUTS, "next.csv", "data/gap.json", "data/holdout/c.csv")),
    strangers=st.lists(st.sampled_from(PLACES), max_size=3, unique=True).map(tuple),
    link=st.none()
    | st.tuples(
        st.sampled_from(("gap.json", "model.yaml", "holdout", "holdout/c.csv")),
        st.sampled_from(("data/a.csv", "data/holdout", "data", "nothing")),
    ),
    hard_link=st.none()
    | st.tuples(
        st.sampled_from(("gap.json", "model.yaml", "curves.json", "holdout/c.csv")),
        st.sampled_from(("data/a.csv", "data/dataset.yaml")),
    ),
    listed=st.booleans(),
)


def lay(root: Path, layout: Layout) -> tuple[Path, Path, Path]:
    """Make the files; give dataset, model and the folder of the result."""
    data = root / "data"
    model = root / layout.model
    files = {
        data / "a.csv": table(1.0),
        data / layout.hold_out: table(0.7),
        data / "dataset.yaml": (
            "name: bench\n"
            "time: {column: time_s, unit: s}\n"
            "input: {column: current_A, unit: A}\n"
            "output: {column: displacement_um, unit: um}\n"
            "noise_rms: 0.01\n"
            "records:\n"
            "  - {file: a.csv, use: fit}\n"
            f"  - {{file: {layout.hold_out}, use: hold-out}}\n"
        ),
        model: MODEL,
    }
    for path, text in files.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        if layout.listed:
            from hystbench.files import write_text

            write_text(path, text)
        else:
            path.write_text(text)
    (root / "alias").symlink_to("data", target_is_directory=True)
    (root / "out").mkdir(exist_ok=True)
    out = root / layout.out
    for name in layout.strangers:
        if not os.path.lexists(out / name):
            make(out / name, lambda path: path.write_text(f"mine, {path.name}"))
    if layout.link is not None:
        name, to = layout.link
        make(out / name, lambda path: path.symlink_to(root / to))
    if layout.hard_link is not None:
        name, to = layout.hard_link
        make(out / name, lambda path: path.hardlink_to(root / to))
    return data / "dataset.yaml", model, out


def make(path: Path, how) -> None:
    """Put something where nothing is, if it can be put there."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        how(path)
    except OSError:  # something stands there, or above it
        pass


def content(root: Path) -> dict[str, str]:
    """Everything that is there: bytes of files and targets of links."""
    found = {}
    for place, folders, files in os.walk(root):
        for name in (*folders, *files):
            path = Path(place, name)
            if path.is_symlink():
                found[str(path.relative_to(root))] = f"-> {path.readlink()}"
            elif path.is_file():
                found[str(path.relative_to(root))] = path.read_bytes().hex()
    return found


CONTENT = {
    "verdict": "no-gap",
    "reason": "none is there",
    "effects": [],
    "withdrawn": None,
    "warnings": [],
}


@dataclass(frozen=True)
class Found:
    """What a search would give, as far as it is written."""

    base: Any
    model: Any
    curves: dict
    content: dict
    state: None = None
    floor: None = None
    black_box: None = None
    rungs: tuple = ()
    own: None = None
    experiment: None = None


@contextmanager
def searched():
    """Replace the search; count how often it was paid."""
    calls = []

    def find(evidence, base, *others):
        calls.append(evidence.name)
        return Found(
            base=base,
            model=base,
            curves={"run": len(calls)},
            content=CONTENT | {"run": len(calls)},
        )

    def show_on_hold_out(decided, evidence):
        outputs = [(record.y, record.y) for record in evidence.hold_out]
        return run_module.Outcome(decided.fitted.base, decided.content, outputs)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(run_module, "search_and_judge", find)
        patch.setattr(run_module, "show_on_hold_out", show_on_hold_out)
        yield calls


def invoke(words) -> str | None:
    """Run ``hystbench gap``; give the line of a refusal."""
    result = CliRunner().invoke(gap, words)
    if result.exit_code == 0:
        return None
    assert isinstance(result.exception, InputError), result.exception
    told = str(result.exception)
    assert "\n" not in told
    return told


@given(layout=layouts)
@example(layout=Layout(strangers=("holdout/notes.csv",)))
@example(layout=Layout(out=".", model="model.yaml", hold_out="c.csv"))
@example(layout=Layout(out="data", hold_out="c.csv", model="data/model.yaml"))
@example(layout=Layout(hold_out="c.csv", listed=True))
@example(layout=Layout(listed=True, experiment="data/a.csv", out="new/deep/er"))
@example(layout=Layout(out="out", link=("gap.json", "data/a.csv"), model="model.yaml"))
@example(layout=Layout(out="alias", model="model.yaml", hold_out="holdout/c.csv"))
def test_every_byte_is_found_again(layout):
    with tempfile.TemporaryDirectory() as place, searched() as paid:
        root = Path(place).resolve()
        dataset, model, out = lay(root, layout)
        words = [str(dataset), "--model", str(model), "--out", str(out), "--no-report"]
        if layout.experiment is not None:
            words += ["--write-experiment", str(root / layout.experiment)]
        before = content(root)
        told = invoke(words)
        if told is None:
            written = content(root)
            assert before.items() <= written.items()
            assert (out / "gap.json").is_file()
            mine = {path: text for path, text in before.items() if "sha256" not in path}
            # and again, with other files of the same names in the way of nothing
            assert invoke(words) is None
            assert mine.items() <= content(root).items()
            assert len(paid) == 2
        else:
            assert not paid, told
            assert content(root) == before


def test_an_edited_result_and_one_of_an_older_hystbench_are_told(tmp_path):
    layout = Layout(out="out", model="model.yaml")
    with searched() as paid:
        dataset, model, out = lay(tmp_path, layout)
        words = [str(dataset), "--model", str(model), "--out", str(out), "--no-report"]
        assert invoke(words) is None
        (out / "model.yaml").write_text("edited: yes\n")
        before = content(tmp_path)
        assert "model.yaml: changed since hystbench wrote it" in invoke(words)
        assert content(tmp_path) == before
        shutil.rmtree(out / ".hystbench")
        told = invoke(words)
        assert "gap.json: not written by hystbench, or by one that kept no list" in told
        assert len(paid) == 1


def test_records_that_are_held_out_no_more_go_and_notes_beside_them_stay(tmp_path):
    with searched():
        dataset, model, out = lay(tmp_path, Layout(out="out", model="model.yaml"))
        words = [str(dataset), "--model", str(model), "--out", str(out), "--no-report"]
        assert invoke(words) is None
        (out / "holdout" / "notes.csv").write_text("mine")
        shutil.copy(tmp_path / "data/holdout/c.csv", tmp_path / "data/holdout/d.csv")
        text = dataset.read_text().replace("holdout/c.csv", "holdout/d.csv")
        dataset.write_text(text)
        assert invoke(words) is None
    names = {item.name for item in (out / "holdout").iterdir()}
    assert names == {"d.csv", "notes.csv", ".hystbench"}


#: Folders that are looked into; and pages that are edited between their own marks.
READ = {
    ("gap-report", "folder"),
    ("blind-solve", "cases"),
    ("docs", "pages"),
    ("report", "compare"),
    ("report", "captions"),
    ("crate", "results"),
    ("crate", "project"),
    ("clean", "folders"),
}


@pytest.mark.parametrize("name", COMMANDS)
def test_a_place_to_write_that_is_somebody_elses_is_refused_first(name, tmp_path):
    """A command that takes a plain path would write there unguarded."""
    command = group(COMMANDS).get_command(None, name)
    (tmp_path / "mine.csv").write_text("mine")
    for item in command.params:
        if not isinstance(item.type, click.Path):
            continue
        writes = item.type in (options.NEW_FILE, options.NEW_FOLDER)
        counts = isinstance(item.type, options.GuardedPath)
        assert counts or (name, item.name) in READ
        if writes:
            words = [item.opts[0], str(tmp_path / "mine.csv")]
            result = CliRunner().invoke(command, words)
            assert isinstance(result.exception, InputError), result.output
            assert "mine.csv: " in str(result.exception)
    assert content(tmp_path) == {"mine.csv": b"mine".hex()}


@pytest.mark.parametrize("listed", [False, True])
@pytest.mark.parametrize(
    "out", ["data/a.csv", "model.yaml", "data/dataset.yaml", "link.csv", "alias/a.csv"]
)
@pytest.mark.parametrize("command", [load, simulate])
def test_an_input_is_no_output(tmp_path, command, out, listed):
    dataset, model, _ = lay(tmp_path, Layout(model="model.yaml", listed=listed))
    (tmp_path / "link.csv").symlink_to("data/a.csv")
    words = {
        load: [str(dataset), "a"],
        simulate: [str(model), str(tmp_path / "data/a.csv")],
    }[command]
    before = content(tmp_path)
    for words_in_order in ([*words, "--out"], ["--out"]):
        more = words if words_in_order == ["--out"] else []
        given_words = [*words_in_order, str(tmp_path / out), *more]
        result = CliRunner().invoke(command, given_words)
        kept = command is load and out == "model.yaml" and listed
        assert kept or isinstance(result.exception, InputError)
        if not kept:
            assert content(tmp_path) == before


def test_two_outputs_of_one_command_have_two_places(tmp_path):
    dataset, model, out = lay(tmp_path, Layout(out="out", model="model.yaml"))
    words = [str(dataset), "--model", str(model), "--out", str(out), "--no-report"]
    for name in ("gap.json", "holdout/../gap.json", "holdout/c.csv"):
        (out / "holdout").mkdir(exist_ok=True)
        with searched() as paid:
            told = invoke([*words, "--write-experiment", str(out / name)])
        assert "two outputs in one place" in told
        assert not paid


def test_the_real_search_leaves_records_and_model_as_they_were(tmp_path):
    """In the folder of the model it is refused; beside the records it stands."""
    dataset, model, _ = lay(tmp_path, Layout(model="model.yaml"))
    (tmp_path / "data/holdout/notes.csv").write_text("mine")
    (tmp_path / "data/holdout/c.csv").rename(tmp_path / "data/holdout/unseen.csv")
    shutil.copy(tmp_path / "data/holdout/unseen.csv", tmp_path / "data/c.csv")
    text = dataset.read_text().replace("holdout/c.csv", "c.csv")
    dataset.write_text(text)
    before = content(tmp_path)
    words = ["gap", dataset, "--model", model, "--no-report", "--out"]
    refused = run_hystbench(*words, tmp_path)
    assert refused.returncode == 2
    assert refused.stderr.count("\n") == 1
    assert "model.yaml: an input of this command" in refused.stderr
    assert content(tmp_path) == before
    done = run_hystbench(*words, tmp_path / "data")
    assert done.returncode == 0, done.stderr
    after = content(tmp_path)
    assert before.items() <= after.items()
    assert {"data/gap.json", "data/model.yaml", "data/holdout/c.csv"} <= after.keys()
