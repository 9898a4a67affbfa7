"""What a search computed, on disk, so that the next one need not compute it again.

An engineer who rejects a name runs the search again with other effects. The records
are the same, and so is the simulator that was identified from them; most effects were
fitted beside it already. Each such result is kept under a digest of all that it is
made of: the records, the model, the score, and the sources of hystbench and of packages
that add blocks or effects to it. So nothing is ever looked up that another computation
would give. The folder is a cache: who deletes it loses time alone.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from hashlib import blake2b
from importlib import metadata
from pathlib import Path
from typing import Any, TypeVar

from hystbench.blocks.kept_outputs import folder_of_user
from hystbench.files import update_with
from hystbench.kept_files import KeptFiles
from hystbench.record import Record
from hystbench.registered import SOURCES, files_of_installed

Result = TypeVar("Result")

BOUND = 2**28
"""Bytes of all results together, at most."""
LIBRARIES = ("numpy", "scipy")
"""Whose versions results depend on, beside hystbench's own sources."""


class Remembered:
    """A folder of results, a JSON file each.

    Parameters
    ----------
    folder : Path
    say : callable
        As for :class:`hystbench.kept_files.KeptFiles`.

    Attributes
    ----------
    made, found : int
        Results that were computed, and those that an earlier run has spared.
    """

    def __init__(self, folder: Path, say: Callable[[str], None]) -> None:
        self.folder = folder
        self.made = self.found = 0
        self._files = KeptFiles(folder, "*.json", BOUND, say, "results")

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
        self._files.write(file, json.dumps([write(result)]).encode())
        return result

    def _read(self, file: Path) -> Any:
        """Give the list of one that a file holds; of others the result is computed."""
        try:
            content = json.loads(self._files.read(file) or b"")
        except ValueError:
            return None
        return content if isinstance(content, list) and len(content) == 1 else None


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
    """Digest of all sources that results depend on, and of the libraries' versions."""
    whole = blake2b(sys.version.encode(), digest_size=16)
    top = Path(__file__).parents[1]
    own = {
        str(file.relative_to(top)): file
        for file in sorted(top.rglob("*"))
        if file.suffix in SOURCES
    }
    added = files_of_installed("hystbench.blocks", "hystbench.effects")
    update_with(whole, own | {str(file): file for file in added})
    for name in LIBRARIES:
        whole.update(f"{name} {metadata.version(name)}\n".encode())
    return whole.hexdigest()
