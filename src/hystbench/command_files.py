"""What one command reads and writes: no input is written over, nor somebody's file."""

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from pathlib import Path

from hystbench.errors import InputError
from hystbench.written import ENTRIES, NOTED, described, is_ordinary, is_ours


@dataclass
class CommandFiles:
    """What one command reads and writes."""

    inputs: dict[tuple[int, int], Path] = field(default_factory=dict)
    """Files that it reads, by device and number of the file."""
    outputs: dict[Path, Path] = field(default_factory=dict)
    """Files that it will write, as they were given, by where they are."""


_run: ContextVar[CommandFiles | None] = ContextVar("run", default=None)


@contextmanager
def one_run() -> Iterator[None]:
    """Begin a command: what it reads must not be what it writes."""
    before = _run.set(CommandFiles())
    try:
        yield
    finally:
        _run.reset(before)


def reads(path: str | Path) -> None:
    """Tell that a file is an input of this command; outside of one nothing is done.

    Raises
    ------
    InputError
        If it is an output as well.
    """
    run, path = _run.get(), Path(path)
    if run is None:
        return
    try:
        found = path.stat()
    except OSError:
        return  # whoever reads it says so
    run.inputs[found.st_dev, found.st_ino] = path
    for output in run.outputs.values():
        _refuse_input(output)


def is_input(path: str | Path) -> bool:
    """Tell whether this command reads a file, by this name or another."""
    run, found = _run.get(), Path(path).stat()
    return run is not None and (found.st_dev, found.st_ino) in run.inputs


def writes(*paths: str | Path) -> None:
    """Tell which files a command will write, before its work is paid.

    Parameters
    ----------
    *paths : str or Path
        Files; a folder's one by one.

    Raises
    ------
    InputError
        If something stands in the way of one, or two are the same.
    """
    run = _run.get()
    for path in map(Path, paths):
        check_free(path)
        if run is None:
            continue
        place = path.parent.resolve() / path.name
        if place in run.outputs:
            raise InputError(f"{path}: two outputs in one place; expected one each")
        run.outputs[place] = path


def check_free(path: str | Path) -> None:
    """Refuse a place where hystbench may not write a file.

    Raises
    ------
    InputError
        If an input of the command stands there, or something that hystbench did not
        write; if a folder is missing above it and cannot be made.
    """
    path = Path(path)
    check_writable(path.parent)
    known = described(path)
    if not os.path.lexists(path):
        return
    _refuse_input(path)
    if path.is_dir() and not path.is_symlink():
        raise InputError(f"{path}: a folder; expected a file or nothing")
    if is_ours(path):
        return
    if not is_ordinary(path):
        what = "a link" if path.is_symlink() else "no ordinary file"
    elif known:
        what = "changed since hystbench wrote it"
    else:
        what = "not written by hystbench, or by one that kept no list"
    raise InputError(f"{path}: {what}; move it away, or name another place to write to")


def check_writable(folder: str | Path) -> None:
    """Refuse a folder that could not be made or written into, before work is paid.

    Raises
    ------
    InputError
        If a file stands where it or a folder above it has to be, or writing is not
        allowed.
    """
    place = Path(folder).absolute()
    while not os.path.lexists(place):
        place = place.parent
    if not place.is_dir():
        what = "a link to nothing" if not place.exists() else "a file"
        raise InputError(f"{place}: {what}; expected a folder to write into")
    if not os.access(place, os.W_OK | os.X_OK):
        raise InputError(f"{place}: not writable; expected a folder to write into")


def check_replaceable(outputs: Iterable[str], inputs: Iterable[str]) -> None:
    """Refuse what a workflow would remove or replace, as all that is told is its own.

    Parameters
    ----------
    outputs : iterable of str
        Files and folders. Of a folder all goes, so all in it has to be hystbench's own.
    inputs : iterable of str
        Files that are read and that no job makes.

    Raises
    ------
    InputError
        With the first file that hystbench did not write, or that is an input.
    """
    with one_run():
        for source in inputs:
            reads(source)
        for path in map(Path, outputs):
            if path.is_symlink() or not path.is_dir():
                check_free(path)
                continue
            for place, folders, files in os.walk(path):
                here = Path(place)
                links = [name for name in folders if (here / name).is_symlink()]
                hidden = [name for name in folders if name.startswith(ENTRIES)]
                folders[:] = sorted({*folders} - {*links, *hidden})
                for name in sorted({*files, *links} - NOTED):
                    check_free(here / name)


def _refuse_input(output: Path) -> None:
    """Refuse an output that is an input by another name, or by the same."""
    run = _run.get()
    if run is None:
        return
    try:
        found = output.stat()
    except OSError:
        return
    source = run.inputs.get((found.st_dev, found.st_ino))
    if source is not None:
        also = "" if source == output else f" (it is {source})"
        raise InputError(
            f"{output}: an input of this command{also}; name another place to write to"
        )
