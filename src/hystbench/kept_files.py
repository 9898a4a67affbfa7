"""A cache on disk: files that a later run may use again, bounded in size."""

import os
import tempfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path


class KeptFiles:
    """A folder of files, of which those of earlier runs make room for new ones.

    The oldest go first; what this run wrote or read stays, and where nothing else is
    left no more is kept: so a run that needs more than there is room for finds next
    time what it began with. A file is named by what it holds and is nobody's work, so
    no list is kept of it. Who deletes the folder loses time alone.

    Parameters
    ----------
    folder : Path
    pattern : str
        Of the files' paths in the folder.
    bound : int
        Bytes of all files together, at most.
    say : callable
        Told once of what cannot be read or written.
    what : str
        What the files hold, for what is said: ``outputs``.
    """

    def __init__(
        self,
        folder: Path,
        pattern: str,
        bound: int,
        say: Callable[[str], None],
        what: str,
    ) -> None:
        self.folder, self.bound, self.what = folder, bound, what
        self._say, self._said = say, set[str]()
        self._usable, self._used = True, set[Path]()
        there = []
        try:
            for file in folder.glob(pattern):
                with suppress(FileNotFoundError):  # another run removes it
                    about = file.stat()
                    there.append((about.st_mtime, file, about.st_size))
        except OSError as error:
            self._give_up(error)
        self._sizes = {file: size for _, file, size in sorted(there)}
        """Size of each file, the oldest first."""

    def read(self, file: Path) -> bytes | None:
        """Give what a file holds; None where there is none to be read."""
        try:
            content = file.read_bytes()
        except OSError:
            return None
        self._used.add(file)
        with suppress(OSError):  # a file that only looks older than it is does no harm
            os.utime(file)
        return content

    def write(self, file: Path, content: bytes) -> None:
        """Write a file whole or not at all, if there is room and it can be written."""
        if not self._usable or not self._has_room(len(content)):
            return
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
            handle, name = tempfile.mkstemp(dir=file.parent)
            try:
                with os.fdopen(handle, "wb") as stream:
                    stream.write(content)
                Path(name).replace(file)
            finally:
                Path(name).unlink(missing_ok=True)
        except OSError as error:
            self._give_up(error)
            return
        self._sizes[file] = len(content)
        self._used.add(file)

    def remove(self, file: Path) -> None:
        """Remove a file."""
        self._sizes.pop(file, None)
        file.unlink(missing_ok=True)

    def say_once(self, line: str) -> None:
        """Say one line of each sort: a broken disk would say thousands."""
        sort = line.rpartition(";")[2]
        if sort not in self._said:
            self._said.add(sort)
            self._say(line)

    def _has_room(self, size: int) -> bool:
        total = sum(self._sizes.values()) + size
        for file in [file for file in self._sizes if file not in self._used]:
            if total <= self.bound:
                break
            total -= self._sizes[file]
            self.remove(file)
        if total > self.bound:
            full = f"{self.bound >> 20} MiB are full"
            self.say_once(f"{self.folder}: {full}; no more {self.what} are kept")
        return total <= self.bound

    def _give_up(self, error: OSError) -> None:
        self._usable = False
        self.say_once(f"{self.folder}: {error.strerror}; {self.what} are not kept")
