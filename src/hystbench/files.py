"""Writing files whole or not at all."""

from __future__ import annotations

import csv
import hashlib
import json
import os
import shutil
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from hystbench.errors import InputError


def check_writable(folder: str | Path) -> None:
    """Refuse a folder that could not be made or written into, before work is paid.

    Raises
    ------
    InputError
        If a file stands where it or a folder above it has to be, or writing is not
        allowed.
    """
    place = Path(folder).absolute()
    while not place.exists():
        place = place.parent
    if not place.is_dir():
        raise InputError(f"{place}: a file; expected a folder to write into")
    if not os.access(place, os.W_OK | os.X_OK):
        raise InputError(f"{place}: not writable; expected a folder to write into")


@contextmanager
def atomic_path(path: str | Path) -> Iterator[Path]:
    """Give a temporary path beside ``path`` that takes its place on success.

    A failure inside the block leaves what was at ``path`` as it was.
    """
    final = Path(path)
    final.parent.mkdir(parents=True, exist_ok=True)
    temporary = final.with_name(f".{final.stem}.{os.getpid()}{final.suffix}")
    try:
        yield temporary
        temporary.replace(final)
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def whole_folder(folder: str | Path, ours: Sequence[str]) -> Iterator[Path]:
    """Give a fresh folder whose files take their places in ``folder`` on success.

    A failure inside the block, or while files take their places, leaves ``folder`` as
    it was, or not there if it was not.

    Parameters
    ----------
    folder : str or Path
    ours : sequence of str
        Patterns, relative to the folder, of files that an earlier result may have left:
        those that the new one does not have go. Any other file stays.

    Raises
    ------
    InputError
        If something else than a file, or than a folder, stands where one has to go.
    """
    final = Path(folder).resolve()
    parent = final if final.is_dir() else final.parent
    parent.mkdir(parents=True, exist_ok=True)
    # Where the files will stand, so that to put them there is to rename them.
    temporary = Path(tempfile.mkdtemp(prefix=f".{final.name}.", dir=parent))
    new = temporary / "new"
    try:
        new.mkdir()
        yield new
        if final.exists():
            _take_places(new, final, temporary / "old", ours)
        else:
            new.rename(final)
    finally:
        shutil.rmtree(temporary)


def _take_places(new: Path, final: Path, old: Path, ours: Sequence[str]) -> None:
    """Move the files of a new folder into one that exists, all or none."""
    coming = [item.relative_to(new) for item in new.rglob("*") if item.is_file()]
    for name in coming:
        if (final / name).is_dir():
            raise InputError(f"{final / name}: a folder; expected a file or nothing")
        if (final / name).parent.is_file():
            raise InputError(f"{final / name.parent}: a file; expected a folder")
    there = {item for pattern in ours for item in final.glob(pattern)}
    there |= {final / name for name in coming}
    going = sorted(item.relative_to(final) for item in there if item.is_file())
    moves = [(final / name, old / name) for name in going]
    moves += [(new / name, final / name) for name in coming]
    done: list[tuple[Path, Path]] = []
    try:
        for source, target in moves:
            target.parent.mkdir(parents=True, exist_ok=True)
            source.rename(target)
            done.append((source, target))
    except BaseException:
        for source, target in reversed(done):
            target.rename(source)
        raise


def write_text(path: str | Path, text: str) -> None:
    """Write a text file whole or not at all."""
    with atomic_path(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def write_json(path: str | Path, content: Any) -> None:
    """Write JSON that any reader takes: NaN and infinity are refused."""
    write_text(path, json.dumps(content, indent=1, allow_nan=False) + "\n")


def read_json(path: str | Path) -> Any:
    """Read a JSON file."""
    return json.loads(Path(path).read_text(encoding="utf-8"))


def write_csv(
    path: str | Path, columns: Sequence[str], rows: Iterable[Sequence[Any]]
) -> None:
    """Write a CSV file whole or not at all; None makes an empty cell."""
    with (
        atomic_path(path) as temporary,
        temporary.open("w", newline="", encoding="utf-8") as stream,
    ):
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(rows)


def digest(folder: str | Path, pattern: str = "*") -> str:
    """SHA-256 of all files below a folder that match: their names and contents."""
    whole = hashlib.sha256()
    folder = Path(folder)
    for file in sorted(folder.rglob(pattern)):
        if file.is_file():
            content = file.read_bytes()
            name = file.relative_to(folder).as_posix()
            whole.update(f"{name} {len(content)}\n".encode() + content)
    return whole.hexdigest()
