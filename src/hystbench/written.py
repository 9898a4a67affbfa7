"""What hystbench wrote, so that nothing else is ever written over or removed.

Beside each file that is written stands an entry in the hidden folder ``.hystbench``:
the file's SHA-256, in the form of ``sha256sum``. A file is hystbench's own as long as
it is an ordinary file that its entry describes. Anything else that stands where
something is to be written is somebody's, and refused.

An entry of each file, and not one list: jobs that write into one folder at the same
time, on several machines too, then need no lock. An entry is written before its file
takes its place, and describes the file that it replaces as well: whenever a run is cut
off, what is there is known.
"""

import hashlib
import os
import re
import stat
import tempfile
from collections.abc import Iterable
from pathlib import Path

from hystbench.errors import InputError
from hystbench.scratch import remove_tree

ENTRIES = ".hystbench"
"""Folder of the entries, beside the files that they describe."""

TEMPORARY = ".hystbench-"
"""Beginning of the names of folders in which files grow; a killed run leaves them."""
KEPT = 3
"""Digests of earlier contents that an entry keeps."""

LOGS = "logs"
"""What stands among the entries of a folder of logs."""
LOG_SUFFIXES = {".log", ".tsv"}
NOTED = {".snakemake_timestamp"}
"""What Snakemake itself leaves in a folder that a job wrote."""

_LINE = re.compile(r"([0-9a-f]{64})  (.+)")


def entry_of(path: Path) -> Path:
    """Give the file that holds the entry of a file."""
    return path.parent / ENTRIES / f"{path.name}.sha256"


def is_ours(path: str | Path) -> bool:
    """Tell whether hystbench wrote a file and nobody changed it since.

    Raises
    ------
    InputError
        If what stands in the place of its entry is none.
    """
    path = Path(path)
    if not is_ordinary(path):
        return False
    known = described(path)
    return bool(known) and sha256(path) in known


def check_unchanged(path: str | Path) -> None:
    """Refuse to read a file that hystbench wrote and somebody changed since.

    What is to be read from it may no longer be there. A file without an entry is not
    ours, and may hold anything.

    Raises
    ------
    InputError
        If it was changed.
    """
    path = Path(path)
    if described(path) and path.exists() and not is_ours(path):
        raise InputError(
            f"{path}: changed since hystbench wrote it; move it away, and the run "
            "makes it again"
        )


def will_write(path: Path, content: Path) -> None:
    """Enter a file that is about to take its place.

    Parameters
    ----------
    path : Path
        Its place.
    content : Path
        The file itself, where it stands until then.
    """
    kept = described(path)[-KEPT:]
    if is_ours(path):
        kept.append(sha256(path))
    entry = entry_of(path)
    entry.parent.mkdir(parents=True, exist_ok=True)
    lines = dict.fromkeys([*kept, sha256(content)])
    text = "".join(f"{line}  {path.name}\n" for line in lines)
    handle, name = tempfile.mkstemp(dir=entry.parent)
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as stream:
            stream.write(text)
        # as readable as the file that it describes
        Path(name).chmod(stat.S_IMODE(content.stat().st_mode))
        Path(name).replace(entry)
    finally:
        Path(name).unlink(missing_ok=True)


def remove(path: str | Path) -> bool:
    """Remove a file and its entry, if it is hystbench's own.

    Returns
    -------
    bool
        Whether nothing is left there.
    """
    path = Path(path)
    if not os.path.lexists(path):
        return True
    if not is_ours(path):
        return False
    path.unlink()
    forget(path)
    return True


def forget(path: Path) -> None:
    """Remove the entry of a file that is gone, and the folder of the last entry."""
    entry = entry_of(path)
    if described(path):
        entry.unlink()
    if entry.parent.is_dir() and not any(entry.parent.iterdir()):
        entry.parent.rmdir()


def remove_below(folder: str | Path) -> list[Path]:
    """Remove all below a folder that is hystbench's own, and folders left empty.

    Returns
    -------
    list of Path
        Files and links that stay, for hystbench did not write them.
    """
    top = Path(folder)
    left: list[Path] = []
    logs = [mark.parent.parent for mark in top.rglob(f"{ENTRIES}/{LOGS}")]
    for place, folders, files in os.walk(top, topdown=False):
        here = Path(place)
        if any(part.startswith(ENTRIES) for part in here.relative_to(top).parts):
            continue  # seen to beside the files that it describes
        for name in folders:
            if name.startswith(TEMPORARY):
                remove_tree(here / name)
        links = [name for name in folders if (here / name).is_symlink()]
        left += [here / name for name in sorted(links)]
        for file in (here / name for name in sorted(files)):
            is_log = file.suffix in LOG_SUFFIXES and any(
                file.is_relative_to(known) for known in logs
            )
            if file.name in NOTED or (is_log and is_ordinary(file)):
                file.unlink()
            elif not remove(file):
                left.append(file)
        if here in logs and not any(item.name != ENTRIES for item in here.iterdir()):
            (here / ENTRIES / LOGS).unlink()
            (here / ENTRIES).rmdir()
        for entry in (here / ENTRIES).glob("*.sha256"):
            forget(here / entry.stem)  # its file was gone before
        if not here.is_symlink() and not any(here.iterdir()):
            here.rmdir()
    return left


def claim_logs(folder: str | Path, logs: Iterable[str]) -> None:
    """Take a folder for logs, which a shell writes and so no entry describes.

    Parameters
    ----------
    folder : str or Path
        From its first run on it is known to be the workflow's.
    logs : iterable of str
        Files below it that are about to be written.

    Raises
    ------
    InputError
        If one of them is there, and is a link or the folder is not the workflow's.
    """
    mark = Path(folder, ENTRIES, LOGS)
    for log in map(Path, logs):
        if os.path.lexists(log) and not (mark.is_file() and is_ordinary(log)):
            raise InputError(
                f"{log}: no log of this workflow, or of one that kept no list; "
                "move it away"
            )
    if not mark.is_file():
        mark.parent.mkdir(parents=True, exist_ok=True)
        mark.write_text("The logs in this folder are replaced and removed.\n")


def is_ordinary(path: Path) -> bool:
    """Tell whether a file is there, and is no link, folder or device."""
    try:
        return stat.S_ISREG(path.lstat().st_mode)
    except OSError:
        return False


def described(path: Path) -> list[str]:
    """Give the digests in a file's entry; none where there is no entry."""
    entry = entry_of(path)
    if not os.path.lexists(entry):
        if os.path.lexists(entry.parent) and not entry.parent.is_dir():
            raise InputError(
                f"{entry.parent}: a file; expected hystbench's list of what it wrote"
            )
        return []
    found = []
    lines = (
        entry.read_text(encoding="utf-8", errors="replace").splitlines()
        if is_ordinary(entry)
        else [""]
    )
    for line in lines:
        match = _LINE.fullmatch(line)
        if match is None:
            raise InputError(
                f"{entry}: no entry of hystbench's list of what it wrote; "
                "move it away, or name another place to write to"
            )
        found.append(match[1])
    return found


def sha256(path: Path) -> str:
    """Compute the SHA-256 of a file, in hexadecimal digits."""
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()
