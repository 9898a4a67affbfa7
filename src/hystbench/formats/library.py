"""Libraries that are not installed with hystbench itself."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from hystbench.errors import InputError


def library(name: str, package: str, path: Path, extra: str = "formats") -> Any:
    """Import a library that a file needs.

    Parameters
    ----------
    name : str
        As Python imports it.
    package : str
        As pip installs it.
    path : Path
        The file, for the message.
    extra : str
        The group of pyproject.toml that it belongs to.

    Raises
    ------
    InputError
        If it is not installed: what to install.
    """
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise InputError(
            f"{path}: needs the package {package} ({error}); install it with "
            f"\"pip install 'hystbench[{extra}]'\" or 'pip install {package}'"
        ) from error


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
        said = " ".join(f"{type(error).__name__}: {error}".split())
        raise InputError(f"{path}: no readable {kind} ({said})") from error
