"""Writing files whole or not at all, and over no file of somebody else's."""

import contextlib
import csv
import errno
import hashlib
import json
import math
import os
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TextIO

from hystbench.command_files import check_free, check_writable, is_input
from hystbench.errors import InputError
from hystbench.interrupt import held
from hystbench.scratch import remove_tree, scratch_folder
from hystbench.written import (
    ENTRIES,
    TEMPORARY,
    check_unchanged,
    forget,
    is_ours,
    will_write,
)


@contextmanager
def atomic_path(path: str | Path, *, edit: bool = False) -> Iterator[Path]:
    """Give a temporary path that takes its place at ``path`` on success.

    A failure inside the block leaves what was at ``path`` as it was.

    Parameters
    ----------
    path : str or Path
    edit : bool
        Whether to change a file that somebody else wrote, as an editor does; it stays
        theirs.

    Raises
    ------
    InputError
        If something that hystbench did not write stands there, or an input of the
        command; unless it is to be edited.
    OSError
        If the disk does not take it; with the name ``path``.
    """
    final = Path(path)
    if not edit:
        check_free(final)
    final.parent.mkdir(parents=True, exist_ok=True)
    # Where the file will stand, so that to put it there is to rename it.
    with (
        _named({}, final),
        scratch_folder(TEMPORARY, final.parent) as place,
        _named({place: final.parent}, final),
    ):
        yield place / final.name
        if not edit:
            check_free(final)
            will_write(final, place / final.name)
        (place / final.name).replace(final)


@contextmanager
def whole_folder(folder: str | Path, ours: Sequence[str]) -> Iterator[Path]:
    """Give a fresh folder whose files take their places in ``folder`` on success.

    A failure inside the block, or while files take their places, leaves ``folder`` as
    it was, or not there if it was not.

    Parameters
    ----------
    folder : str or Path
    ours : sequence of str
        Files, relative to the folder, that may be written, as names or patterns. What
        an earlier run wrote of them and this one does not goes, unless somebody changed
        it. Any other file stays.

    Raises
    ------
    InputError
        If something that hystbench did not write stands where a file has to go, or an
        input of the command; of plain names before the block is run.
    OSError
        If the disk does not take it; with the name of the file in ``folder``.
    """
    final = Path(folder).resolve()
    check_writable(final)
    for name in ours:
        if "*" not in name:
            check_free(Path(folder, name))
    parent = final if final.is_dir() else final.parent
    parent.mkdir(parents=True, exist_ok=True)
    # Where the files will stand, so that to put them there is to rename them.
    with _named({}, Path(folder)):
        temporary = Path(tempfile.mkdtemp(prefix=TEMPORARY, dir=parent))
    new = temporary / "new"
    try:
        with _named({new: Path(folder)}, Path(folder)):
            new.mkdir()
            yield new
            if final.exists():
                _take_places(new, final, temporary / "old", ours)
                remove_tree(temporary / "old")
            else:
                new.rename(final)
    finally:
        remove_tree(new)
        with contextlib.suppress(OSError):
            temporary.rmdir()  # not where old files could not be put back


def _take_places(new: Path, final: Path, old: Path, ours: Sequence[str]) -> None:
    """Move the files of a new folder into one that exists, all or none."""
    coming = [
        item.relative_to(new)
        for item in sorted(new.rglob("*"))
        if item.is_file() and ENTRIES not in item.relative_to(new).parts
    ]
    for name in coming:
        check_free(final / name)
    there = {item for pattern in ours for item in final.glob(pattern)}
    there -= {final / name for name in coming}
    stale = sorted(
        item.relative_to(final)
        for item in there
        if is_ours(item) and not is_input(item)
    )
    going = [name for name in coming if (final / name).exists()] + stale
    moves = [(final / name, old / name) for name in going]
    moves += [(new / name, final / name) for name in coming]
    done: list[tuple[Path, Path]] = []
    with held():
        try:
            for name in coming:
                will_write(final / name, new / name)
            for source, target in moves:
                target.parent.mkdir(parents=True, exist_ok=True)
                done.append((source, target))
                source.rename(target)
        except BaseException:
            for source, target in reversed(done):
                if not source.exists():
                    target.rename(source)
            remove_tree(old)
            raise
        for name in stale:
            forget(final / name)


@contextmanager
def _named(places: Mapping[Path, Path], whole: Path) -> Iterator[None]:
    """Let an error of the disk name the file that was asked for, not where it grew.

    Parameters
    ----------
    places : mapping of Path to Path
        Temporary folders, and the folders that they stand for.
    whole : Path
        What is named where the error names nothing.
    """
    try:
        yield
    except OSError as error:
        if isinstance(error, BrokenPipeError):
            raise  # of what is printed
        name = None if error.filename is None else Path(os.fsdecode(error.filename))
        for place, final in places.items():
            if name is not None and name.is_relative_to(place):
                name = final / name.relative_to(place)
        if name is None or any(
            part == ENTRIES or part.startswith(TEMPORARY) for part in name.parts
        ):
            name = whole
        # NumPy tells in words alone that less was written than was asked for.
        told = error.strerror or str(error)
        raise OSError(error.errno or errno.EIO, told, str(name)) from error


def write_text(path: str | Path, text: str, *, edit: bool = False) -> None:
    """Write a text file whole or not at all; ``edit`` as for :func:`atomic_path`."""
    with atomic_path(path, edit=edit) as temporary:
        temporary.write_text(text, encoding="utf-8")


def write_json(path: str | Path, content: Any) -> None:
    """Write JSON that any reader takes: NaN and infinity are refused."""
    write_text(path, json.dumps(content, indent=1, allow_nan=False) + "\n")


def finite_or_none(value: float) -> float | None:
    """Give a number as JSON can hold it: infinity and NaN are none."""
    return float(value) if math.isfinite(value) else None


def read_json(path: str | Path) -> Any:
    """Read a JSON file.

    Raises
    ------
    InputError
        If it is none, or is hystbench's own and was changed.
    """
    check_unchanged(path)
    try:
        return json.loads(Path(path).read_text(encoding="utf-8"))
    except ValueError as error:
        raise InputError(f"{path}: not a readable JSON file ({error})") from error


def write_csv(
    path: str | Path, columns: Sequence[str], rows: Iterable[Sequence[Any]]
) -> None:
    """Write a CSV file whole or not at all; None makes an empty cell."""
    with _table(path, columns) as stream:
        csv.writer(stream, lineterminator="\n").writerows(rows)


def write_columns(
    path: str | Path, columns: Mapping[str, Iterable[float]], digits: int = 12
) -> None:
    """Write columns of numbers as CSV, each with so many digits."""
    line = ",".join([f"%.{digits}g"] * len(columns)) + "\n"
    rows = zip(*(list(column) for column in columns.values()), strict=True)
    with _table(path, list(columns)) as stream:
        stream.write("".join(map(line.__mod__, rows)))


@contextmanager
def _table(path: str | Path, columns: Sequence[str]) -> Iterator[TextIO]:
    """Open a CSV file, in which the names of its columns stand."""
    with (
        atomic_path(path) as temporary,
        temporary.open("w", newline="", encoding="utf-8") as stream,
    ):
        csv.writer(stream, lineterminator="\n").writerow(columns)
        yield stream


def markdown_table(columns: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Write a Markdown table; a bar in a cell is escaped.

    Cells are not padded, as tabulate pads them: one long cell would fill its whole
    column with spaces, and a changed one would change every row.
    """
    lines = [columns, ["---"] * len(columns), *rows]
    told = ([cell.replace("|", r"\|") for cell in cells] for cells in lines)
    return "\n".join("| " + " | ".join(cells) + " |" for cells in told)


def digest(folder: str | Path, pattern: str = "*") -> str:
    """SHA-256 of all files below a folder that match: their names and contents.

    What hystbench notes of the files that it wrote is none of them.
    """
    whole = hashlib.sha256()
    files = sorted(file for file in Path(folder).rglob(pattern) if file.is_file())
    named = {file.relative_to(folder): file for file in files}
    own = {k.as_posix(): v for k, v in named.items() if ENTRIES not in k.parts}
    update_with(whole, own)
    return whole.hexdigest()


def update_with(whole: Any, files: Mapping[str, Path]) -> None:
    """Take files into a digest, in their order: name, size and content of each."""
    for name, file in files.items():
        content = file.read_bytes()
        whole.update(f"{name} {len(content)}\n".encode() + content)
