"""What libraries raise of damaged files, in one line."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hystbench.errors import InputError, in_line


@contextmanager
def told(path: Path, kind: str) -> Iterator[None]:
    """Turn what a library raises of a damaged file into one line."""
    try:
        yield
    except InputError:
        raise
    except MemoryError as error:
        raise InputError(f"{path}: more than fits into memory") from error
    except Exception as error:
        # Libraries raise anything of what is damaged.
        raise InputError(f"{path}: no readable {kind} ({in_line(error)})") from error
