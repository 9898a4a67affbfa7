"""The files that a dataset.yaml names: each there, named once, and unchanged."""

import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from hystbench.command_files import reads
from hystbench.errors import InputError, nearest, short
from hystbench.formats import SUFFIXES
from hystbench.samples import record_name
from hystbench.written import sha256

#: Names of records: they name results, and braces are Snakemake's own.
RECORD_NAME = re.compile(r"[^.\-\s{}*?\\\x00-\x1f][^{}*?\\\x00-\x1f]*")


def file_of(about: Path, entry: Mapping[str, Any]) -> Path:
    """Give the file of a record, also from a folder that is not there yet."""
    name: str = entry["file"]
    if about.parent.is_dir():
        return about.parent / name
    return Path(os.path.normpath(about.parent.resolve() / name))


def check_files(about: Path, entries: Sequence[Mapping[str, Any]]) -> None:
    """Refuse a record whose file is none, and two records of one name."""
    seen: dict[str, str] = {}
    for entry in entries:
        name, record = entry["file"], record_name(entry)
        place, file = f"{about}: records", file_of(about, entry)
        if not RECORD_NAME.fullmatch(record):
            raise InputError(
                f"{place}: {short(record if 'name' in entry else name)} names results "
                "as well; expected a name that begins with a letter or digit and has "
                "none of {}*?\\"
            )
        if record in seen:
            also = seen[record]
            raise InputError(
                f"{place}: {name!r} stands there twice; expected each once, or a "
                "'name' each where they are parts of one file"
                if also == name
                else f"{place}: {also!r} and {name!r} are both named {record!r}; "
                "expected a name each, as it names its results"
            )
        seen[record] = name
        if file.is_dir():
            raise InputError(f"{place}: {name!r} is a folder; expected a CSV file")
        if not _is_file(file):
            raise InputError(f"{place}: no file {name!r}; {_other_file(about, name)}")
        reads(file)


def _is_file(file: Path) -> bool:
    try:
        return file.is_file()
    except (OSError, ValueError):  # links in a circle, or no name of a file at all
        return False


def _other_file(about: Path, name: str) -> str:
    """Name the file that may be meant, from the folder of dataset.yaml."""
    folder = (about.parent / name).parent
    if not folder.is_dir():
        return f"there is no folder {str(folder)!r}"
    there = sorted(
        item.name
        for item in folder.iterdir()
        if item.suffix.lower() in SUFFIXES and item.is_file()
    )
    if not there:
        return f"expected a CSV file; the folder {str(folder)!r} has none"
    before = Path(name).parent
    return nearest(name, [str(before / item) for item in there])


def check_digest(about: Path, file: Path, entry: Mapping[str, Any]) -> None:
    """Refuse a file that is not the one that was described."""
    if "sha256" not in entry:
        return
    try:
        found = sha256(file)
    except OSError:
        return  # who reads it says so
    if found != entry["sha256"]:
        raise InputError(
            f"{about}: records: {entry['file']!r} is not the file that was "
            f"described: its SHA-256 begins {found[:12]}, not {entry['sha256'][:12]}; "
            "run 'hystbench init' again, or take 'sha256' away"
        )
