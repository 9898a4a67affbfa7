"""Libraries: those that are not installed with hystbench itself, and its own in C."""

import ctypes
import importlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hystbench.errors import InputError


def library(name: str, package: str, place: object, extra: str) -> Any:
    """Import a library that a file or a simulator needs.

    Parameters
    ----------
    name : str
        As Python imports it.
    package : str
        As pip installs it.
    place : object
        What needs it, for the message.
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
            f"{place}: needs the package {package} ({error}); install it with "
            f"\"pip install 'hystbench[{extra}]'\" or 'pip install {package}'"
        ) from error


SIZE, REAL, ARRAY = ctypes.c_ssize_t, ctypes.c_double, ctypes.c_void_p
_KINDS = {"i": SIZE, "f": REAL, "a": ARRAY}


def compiled(
    path: Path, signatures: Mapping[str, tuple[Any, str]], loops: str
) -> ctypes.CDLL:
    """Load a shared library of hystbench's own and declare its functions.

    Parameters
    ----------
    path : Path
    signatures : mapping of str to (type, str)
        Of each function what it returns and a letter for each argument: i for a size,
        f for a number, a for an array.
    loops : str
        What the library holds, for the message.

    Raises
    ------
    InputError
        If it was not built, or was built for another machine.
    """
    try:
        found = ctypes.CDLL(str(path))
    except OSError as error:
        raise InputError(
            f"{path}: {loops} do not load ({error}); build them with "
            "`pip install --no-deps --no-build-isolation -e .`"
        ) from error
    for name, (result, arguments) in signatures.items():
        function = getattr(found, name)
        function.restype = result
        function.argtypes = [_KINDS[kind] for kind in arguments]
    return found
