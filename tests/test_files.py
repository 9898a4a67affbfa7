"""Folders are written whole or not at all."""

import os
from pathlib import Path

import pytest

from hystbench.errors import InputError
from hystbench.files import check_writable, whole_folder

OURS = ("result.txt", "page.txt", "parts/*.csv")


def tree(folder):
    """All that is in a folder, hidden files too."""
    return {
        item.relative_to(folder).as_posix(): item.read_text()
        for item in folder.rglob("*")
        if item.is_file()
    }


def write(folder, files):
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)


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
    write(tmp_path, OLD | FOREIGN)
    with whole_folder(tmp_path, OURS) as folder:
        write(folder, NEW)
    assert tree(tmp_path) == NEW | FOREIGN


@pytest.mark.parametrize("there", [OLD | FOREIGN, FOREIGN, {}])
def test_what_fails_leaves_all_as_it_was(tmp_path, there):
    out = tmp_path / "out"
    write(out, there)

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
    write(tmp_path, OLD | FOREIGN)
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
