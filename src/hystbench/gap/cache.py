"""What a search computed, on disk, so that the next one need not compute it again.

An engineer who rejects a name runs the search again with other effects. The records
are the same, and so is the simulator that was identified from them; most effects were
fitted beside it already. Each such result is kept under a digest of all that it is
made of: the records, the model, the score, and hystbench's own sources. So nothing is
ever looked up that another computation would give. The folder is a cache: who deletes
it loses time alone.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from functools import cache
from hashlib import blake2b
from importlib import metadata
from pathlib import Path
from typing import Any, TypeVar

from hystbench.blocks.kept_outputs import folder_of_user
from hystbench.record import Record

Result = TypeVar("Result")

BOUND = 2**28
"""Bytes of all results together, at most."""
LIBRARIES = ("numpy", "scipy")
"""Whose versions results depend on, beside hystbench's own sources."""


class Remembered:
    """A folder of results, a JSON file each; the oldest make room for new ones.

    Parameters
    ----------
    folder : Path
    say : callable
        Told once where the folder cannot be read or written.
    bound : int
        Bytes of all files together, at most.

    Attributes
    ----------
    made, found : int
        Results that were computed, and those that an earlier run has spared.
    """

    def __init__(
        self, folder: Path, say: Callable[[str], None], bound: int = BOUND
    ) -> None:
        self.folder, self.say, self.bound = folder, say, bound
        self.made = self.found = self._size = 0
        self._usable = True
        self._keep("", None)

    def result(
        self,
        key: Sequence[Any],
        compute: Callable[[], Result],
        write: Callable[[Result], Any],
        read: Callable[[Any], Result],
    ) -> Result:
        """Give a result: an earlier one, or what is computed now.

        Parameters
        ----------
        key : sequence
            Words, numbers and digests: all that the result depends on but hystbench's
            own sources.
        compute : callable
        write, read : callable
            To and from what JSON can hold.
        """
        text = json.dumps([code_digest(), *key], sort_keys=True)
        name = blake2b(text.encode(), digest_size=16).hexdigest()
        file = self.folder / f"{name}.json"
        known = self._read(file)
        if known is not None:
            self.found += 1
            return read(known[0])
        result = compute()
        self.made += 1
        self._keep(json.dumps([write(result)]), file)
        return result

    def _read(self, file: Path) -> Any:
        try:
            content = json.loads(file.read_text(encoding="utf-8"))
            os.utime(file)  # it is among the newest now
        except (OSError, ValueError):
            return None  # it is computed, and written anew
        return content if isinstance(content, list) and len(content) == 1 else None

    def _keep(self, text: str, file: Path | None) -> None:
        """Make room for a result and write it; without a file see what is there."""
        if not self._usable:
            return
        try:
            if file is None or self._size + len(text) > self.bound:
                self._size = self._trimmed(self.bound - len(text))
            if file is not None and len(text) <= self.bound:
                _write(file, text)
                self._size += len(text)
        except OSError as error:
            self._usable = False
            self.say(f"{self.folder}: {error.strerror}; results are not kept")

    def _trimmed(self, most: int) -> int:
        """Remove the oldest results until so many bytes are left; give how many are.

        One that another run removes is passed over.
        """
        found = []
        for file in self.folder.glob("*.json"):
            with suppress(FileNotFoundError):
                about = file.stat()
                found.append((about.st_mtime, file, about.st_size))
        size = sum(each for _, _, each in found)
        for _, file, each in sorted(found):
            if size > most:
                file.unlink(missing_ok=True)
                size -= each
        return size


def _write(file: Path, text: str) -> None:
    """Write a result whole or not at all."""
    file.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(suffix=".json", dir=file.parent)
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as stream:
            stream.write(text)
        Path(name).replace(file)
    finally:
        Path(name).unlink(missing_ok=True)


_current: ContextVar[Remembered | None] = ContextVar("remembered", default=None)


@contextmanager
def remembering(store: Remembered | None) -> Iterator[None]:
    """Let searches within the block look up and keep what they compute."""
    before = _current.set(store)
    try:
        yield
    finally:
        _current.reset(before)


def remembered(
    key: Callable[[], Sequence[Any]],
    compute: Callable[[], Result],
    write: Callable[[Result], Any],
    read: Callable[[Any], Result],
) -> Result:
    """Give a result by its key, computed where nothing is kept.

    Parameters
    ----------
    key : callable
        Gives the key; not called where nothing is kept.
    compute, write, read : callable
        As for :meth:`Remembered.result`.
    """
    store = _current.get()
    return compute() if store is None else store.result(key(), compute, write, read)


def folder() -> Path:
    """Give the user's own place for results, beside that for outputs of functions."""
    return folder_of_user().with_name("searches")


def records_digest(records: Sequence[Record]) -> str:
    """Digest of all that a search reads of records."""
    return " ".join(record.digest for record in records)


@cache
def code_digest() -> str:
    """Digest of hystbench's sources and of the libraries that it computes with."""
    whole = blake2b(sys.version.encode(), digest_size=16)
    top = Path(__file__).parents[1]
    files = (item for item in top.rglob("*") if item.suffix in (".py", ".so", ".yaml"))
    for file in sorted(files):
        content = file.read_bytes()
        whole.update(f"{file.relative_to(top)} {len(content)}\n".encode() + content)
    for name in LIBRARIES:
        whole.update(f"{name} {metadata.version(name)}\n".encode())
    return whole.hexdigest()
