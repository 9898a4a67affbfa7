"""Folders are written whole or not at all."""

import os
import re
from pathlib import Path

import numpy as np
import pytest

from hystbench.command_files import check_writable
from hystbench.compare.rows import read_rows
from hystbench.errors import InputError
from hystbench.files import (
    atomic_path,
    digest,
    read_json,
    whole_folder,
    write_csv,
    write_json,
    write_text,
)
from hystbench.record import load_record
from hystbench.written import ENTRIES, entry_of, is_ours
from tests.gap.made import record

OURS = ("result.txt", "page.txt", "parts/*.csv")


def tree(folder):
    """All that is in a folder, hidden files too, but the list of what was written."""
    return {
        item.relative_to(folder).as_posix(): item.read_text()
        for item in folder.rglob("*")
        if item.is_file() and ENTRIES not in item.parts
    }


def write(folder, files):
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)


def write_ours(folder, files):
    for name, text in files.items():
        write_text(folder / name, text)


OLD = {"result.txt": "old", "page.txt": "old", "parts/a.csv": "old"}
FOREIGN = {"notes.txt": "mine", "parts/notes.txt": "mine", "more/x.csv": "mine"}
NEW = {"result.txt": "new", "parts/b.csv": "new"}


def test_a_folder_that_was_not_there(tmp_path):
    with whole_folder(tmp_path / "deep" / "out", OURS) as folder:
        write(folder, NEW)
        assert not (tmp_path / "deep" / "out").exists()
    assert tree(tmp_path / "deep") == {f"out/{k}": v for k, v in NEW.items()}
    mode = (tmp_path / "deep" / "out").stat().st_mode
    assert mode == (tmp_path / "deep").stat().st_mode


def test_only_what_is_ours_gives_way(tmp_path):
    write_ours(tmp_path, OLD)
    write(tmp_path, FOREIGN)
    with whole_folder(tmp_path, OURS) as folder:
        write(folder, NEW)
    assert tree(tmp_path) == NEW | FOREIGN
    assert all(is_ours(tmp_path / name) for name in NEW)
    assert not entry_of(tmp_path / "page.txt").exists()


@pytest.mark.parametrize("there", [OLD | FOREIGN, FOREIGN, {}])
def test_what_fails_leaves_all_as_it_was(tmp_path, there):
    out = tmp_path / "out"
    write_ours(out, {name: text for name, text in there.items() if name in OLD})
    write(out, {name: text for name, text in there.items() if name in FOREIGN})

    def interrupted():
        with whole_folder(out, OURS) as folder:
            write(folder, NEW)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert tree(tmp_path) == {f"out/{k}": v for k, v in there.items()}
    assert out.exists() is bool(there)


@pytest.mark.parametrize("at", range(5))
def test_what_fails_while_files_take_their_places_is_put_back(
    tmp_path, monkeypatch, at
):
    """Three old files go and two new ones come: each of the five moves may fail."""
    write_ours(tmp_path, OLD)
    write(tmp_path, FOREIGN)
    real, calls = Path.rename, []

    def rename(self, target):
        calls.append(target)
        if len(calls) == at + 1:
            raise OSError("disk full")
        return real(self, target)

    monkeypatch.setattr(Path, "rename", rename)
    with pytest.raises(OSError, match="disk full"), whole_folder(tmp_path, OURS) as new:
        write(new, NEW)
    assert tree(tmp_path) == OLD | FOREIGN
    assert all(is_ours(tmp_path / name) for name in OLD)


@pytest.mark.parametrize(
    ("there", "told"),
    [
        ("result.txt/mine.txt", r"result\.txt: a folder; expected a file or nothing"),
        ("parts", r"parts: a file; expected a folder"),
    ],
)
def test_what_stands_in_the_way_is_named_and_stays(tmp_path, there, told):
    write(tmp_path, {there: "mine"})
    with pytest.raises(InputError, match=told), whole_folder(tmp_path, OURS) as folder:
        write(folder, NEW)
    assert tree(tmp_path) == {there: "mine"}


def test_a_place_that_cannot_be_written_is_refused_and_nothing_is_made(
    tmp_path, monkeypatch
):
    check_writable(tmp_path / "new" / "folder")
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "taken").write_text("mine")
    for inside in ("taken", "taken/deep/er"):
        with pytest.raises(InputError, match=r"taken: a file; expected a folder"):
            check_writable(tmp_path / inside)
    monkeypatch.setattr(os, "access", lambda place, mode: place != tmp_path)
    with pytest.raises(InputError, match=f"{tmp_path.name}: not writable"):
        check_writable(tmp_path / "new")


def test_a_file_of_somebody_elses_is_refused_before_the_block_is_run(tmp_path):
    write(tmp_path, {"result.txt": "mine"})
    told = "result.txt: not written by hystbench"
    for writing in (whole_folder(tmp_path, OURS), atomic_path(tmp_path / "result.txt")):
        with pytest.raises(InputError, match=told), writing:
            raise AssertionError
    assert tree(tmp_path) == {"result.txt": "mine"}


def test_a_result_that_somebody_edited_is_theirs(tmp_path):
    write_ours(tmp_path, OLD)
    (tmp_path / "result.txt").write_text("edited")
    with pytest.raises(InputError, match="changed since hystbench wrote it"):
        write_text(tmp_path / "result.txt", "new")
    (tmp_path / "parts" / "a.csv").write_text("edited")
    (tmp_path / "result.txt").unlink()
    with whole_folder(tmp_path, OURS) as folder:
        write(folder, NEW)
    assert tree(tmp_path) == NEW | {"parts/a.csv": "edited"}


@pytest.mark.parametrize("at", ["entry", "file"])
def test_what_is_cut_off_between_entry_and_file_is_written_again(
    tmp_path, monkeypatch, at
):
    """Whether the old file or the new one is there, the list knows it."""
    write_text(tmp_path / "result.txt", "old")
    real, calls = Path.replace, []

    def replace(self, target):
        calls.append(target)
        if len(calls) == 2 and at == "entry":
            raise KeyboardInterrupt
        real(self, target)
        if len(calls) == 2:
            raise KeyboardInterrupt
        return target

    monkeypatch.setattr(Path, "replace", replace)
    with pytest.raises(KeyboardInterrupt):
        write_text(tmp_path / "result.txt", "new")
    assert calls[0] == entry_of(tmp_path / "result.txt")
    monkeypatch.undo()
    there = "old" if at == "entry" else "new"
    assert tree(tmp_path) == {"result.txt": there}
    write_text(tmp_path / "result.txt", "newer")
    assert tree(tmp_path) == {"result.txt": "newer"}


def test_a_list_that_is_somebody_elses_is_refused(tmp_path):
    write(tmp_path, {ENTRIES: "mine"})
    with pytest.raises(InputError, match="a file; expected hystbench's list"):
        write_text(tmp_path / "a.txt", "new")
    assert (tmp_path / ENTRIES).read_text() == "mine"
    write(tmp_path / "b", {f"{ENTRIES}/a.txt.sha256": "mine"})
    with pytest.raises(InputError, match="no entry of hystbench's list"):
        write_text(tmp_path / "b" / "a.txt", "new")
    assert entry_of(tmp_path / "b" / "a.txt").read_text() == "mine"


def test_the_list_is_no_content_of_a_folder(tmp_path):
    write(tmp_path / "plain", NEW)
    write_ours(tmp_path / "ours", NEW)
    assert digest(tmp_path / "ours") == digest(tmp_path / "plain")


class TestReading:
    """What was edited may no longer hold what a job reads from it."""

    TOLD = "changed since hystbench wrote it; move it away, and the run makes it again"

    def test_json_that_was_edited_is_refused(self, tmp_path):
        file = tmp_path / "run.json"
        write_json(file, {"diverged": False})
        assert read_json(file) == {"diverged": False}
        file.write_text("{}")
        with pytest.raises(InputError, match=f"^{re.escape(str(file))}: {self.TOLD}$"):
            read_json(file)

    def test_json_of_somebody_else_may_hold_anything(self, tmp_path):
        file = tmp_path / "mine.json"
        file.write_text("{}")
        assert read_json(file) == {}

    def test_a_table_that_was_edited_is_refused(self, tmp_path):
        file = tmp_path / "cells.csv"
        write_csv(file, ("signal", "rms"), [("sine", 1.0)])
        assert read_rows(file, ("signal",)) == [{"signal": "sine", "rms": "1.0"}]
        file.write_text("signal,rms\nsine,0.0\n")
        with pytest.raises(InputError, match=self.TOLD):
            read_rows(file, ("signal",))

    def test_a_record_that_was_edited_is_refused(self, tmp_path):
        file = tmp_path / "sine.npz"
        made = record(np.arange(5.0), np.arange(5.0))
        made.save(file)
        assert load_record(file).name == made.name
        file.write_bytes(file.read_bytes()[:-9])
        with pytest.raises(InputError, match=self.TOLD):
            load_record(file)
