"""Folders that are gone when the work in them is done, also when Ctrl-C comes."""

import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hystbench.interrupt import held


@contextmanager
def scratch_folder(prefix: str, parent: str | Path | None = None) -> Iterator[Path]:
    """Give a new folder, and remove it with all in it at the end of the block.

    Parameters
    ----------
    prefix : str
        Of the folder's name.
    parent : str or Path, optional
        Where to make it; by default where the system keeps such folders.

    Raises
    ------
    OSError
        If the disk does not take it.
    """
    with held():
        place = Path(tempfile.mkdtemp(prefix=prefix, dir=parent))
    try:
        yield place
    finally:
        remove_tree(place)


def remove_tree(folder: str | Path) -> None:
    """Remove a folder as far as the disk lets it, if it is there.

    A signal waits meanwhile. If it cut the removal in two, half a folder would stay,
    and Python would close a folder twice.
    """
    with held():
        shutil.rmtree(folder, ignore_errors=True)
